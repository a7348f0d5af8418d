from setuptools import setup

NAME = "turtle_hunt"

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + NAME]),
        ("share/" + NAME, ["package.xml"]),
        ("share/" + NAME + "/launch", ["launch/hunt.launch.py"]),
        ("share/" + NAME + "/config", ["config/hunt.yaml"]),
    ],
    install_requires=["setuptools"],
    entry_points={"console_scripts": ["spawner = turtle_hunt.spawner:main", "hunter = turtle_hunt.hunter:main"]},
)
