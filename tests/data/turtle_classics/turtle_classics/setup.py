from glob import glob

from setuptools import find_packages, setup

NAME = "turtle_classics"

setup(
    name=NAME,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/launch", glob("launch/*.py")),
    ],
    install_requires=["setuptools"],
    entry_points={
        "console_scripts": [
            f"{each} = {NAME}.{each}:main"
            for each in ("square_open_loop", "square_feedback", "spiral", "go_to_goal", "pose_to_tf", "chain_follower")
        ]
    },
)
