import os
from glob import glob

from setuptools import setup

NAME = "frames_workshop"
PROGRAMS = [
    "broken_broadcaster",
    "carrot_fixed",
    "carrot_moving",
    "follower",
    "late_follower",
    "patient_listener",
    "point_transformer",
    "static_frame",
    "turtle_broadcaster",
]

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (os.path.join("share", NAME, "launch"), glob(os.path.join("launch", "*.launch.py"))),
    ],
    install_requires=["setuptools"],
    entry_points={"console_scripts": [f"{each} = {NAME}.{each}:main" for each in PROGRAMS]},
)
