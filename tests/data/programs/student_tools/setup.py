from setuptools import setup

setup(
    name='student_tools',
    version='1.2.0',
    packages=['student_tools'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/student_tools']),
        ('share/student_tools', ['package.xml']),
    ],
    install_requires=['setuptools'],
)
