from glob import glob

from setuptools import find_packages, setup

package_name = "patrol"

setup(
    name=package_name,
    version="0.1.0",
    packages=find_packages(),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"]),
        ("share/" + package_name + "/launch", glob("launch/*.launch.py")),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="You",
    maintainer_email="you@example.com",
    description="A robot that drives from corner to corner",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "planner = patrol.planner:main",
            "driver = patrol.driver:main",
        ],
    },
)
