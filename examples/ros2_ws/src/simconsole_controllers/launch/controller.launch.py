"""Start one of the two controllers: `controller:=graph_controller` (default) or `controller:=rosbridge_controller`."""

from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

PACKAGE = "simconsole_controllers"


def generate_launch_description() -> LaunchDescription:
    """Return the launch arguments and the node."""
    parameters = Path(get_package_share_directory(PACKAGE)) / "config" / "controllers.yaml"
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                "controller",
                default_value="graph_controller",
                choices=["graph_controller", "rosbridge_controller"],
                description="through the ROS 2 graph, or over rosbridge",
            ),
            DeclareLaunchArgument(
                "parameters",
                default_value=str(parameters),
                description="file with host, port, namespace, speed_mps, lateral_accel_mps2, ask_for_autonomy",
            ),
            Node(
                package=PACKAGE,
                executable=LaunchConfiguration("controller"),
                parameters=[LaunchConfiguration("parameters")],
                output="screen",
            ),
        ]
    )
