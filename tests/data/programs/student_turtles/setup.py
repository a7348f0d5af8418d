from setuptools import find_packages, setup
import os
from glob import glob

package_name = 'student_turtles'

setup(
    name=package_name,
    version='0.0.1',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        (os.path.join('share', package_name, 'launch'), glob(os.path.join('launch', '*launch.[pxy][yma]*'))),
        (os.path.join('share', package_name, 'config'), glob('config/*')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='alan',
    maintainer_email='alan@example.org',
    description='TODO: Package description',
    license='TODO: License declaration',
    tests_require=['pytest'],
    entry_points={
        'console_scripts': [
            'menu = student_turtles.menu:main',
            'globals = student_turtles.with_globals:main',
            'spin_once = student_turtles.spin_once_loop:main',
            'go_to_goal = student_turtles.control.go_to_goal:main',
            'patrol = student_turtles.patrol:main',
            'behaviour = student_turtles.behaviour_tree:main',
            'mission = student_turtles.mission:main',
        ],
    },
)
