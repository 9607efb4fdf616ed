"""How colcon installs the package."""

from setuptools import setup

NAME = "simconsole_controllers"

setup(
    name=NAME,
    version="0.1.0",
    packages=[NAME],
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{NAME}"]),
        (f"share/{NAME}", ["package.xml"]),
        (f"share/{NAME}/config", ["config/controllers.yaml"]),
        (f"share/{NAME}/launch", ["launch/controller.launch.py"]),
    ],
    install_requires=["setuptools"],
    extras_require={"rosbridge": ["roslibpy>=2.1"]},
    entry_points={
        "console_scripts": [
            f"graph_controller = {NAME}.graph_controller:main",
            f"rosbridge_controller = {NAME}.rosbridge_controller:main",
        ]
    },
)
