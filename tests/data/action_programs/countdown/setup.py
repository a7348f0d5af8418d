from setuptools import setup

NAME = "countdown"
PROGRAMS = [
    "simple_server",
    "parallel_server",
    "single_goal_server",
    "queue_server",
    "deferring_server",
    "plain_server",
    "asyncio_server",
    "client",
    "cancelling_client",
    "plain_client",
    "blocking_client",
    "asyncio_client",
    "relay",
]

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    entry_points={"console_scripts": [f"{each} = {NAME}.{each}:main" for each in PROGRAMS]},
)
