import os
from glob import glob

from setuptools import find_packages, setup

package_name = 'first_steps'
programs = sorted(
    os.path.splitext(os.path.basename(each))[0]
    for each in glob(os.path.join(package_name, '*.py'))
    if not each.endswith('__init__.py')
)

setup(
    name=package_name,
    version='0.1.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        (os.path.join('share', package_name, 'config'), glob('config/*.yaml')),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='Grace',
    maintainer_email='grace@example.org',
    description='Publishers, services, executors, parameters: what the tutorials teach',
    license='Apache-2.0',
    tests_require=['pytest'],
    entry_points={
        'console_scripts': [f'{each} = {package_name}.{each}:main' for each in programs],
    },
)
