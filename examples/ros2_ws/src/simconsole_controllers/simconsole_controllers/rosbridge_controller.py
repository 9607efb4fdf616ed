"""Drive over rosbridge, with roslibpy: the console may run on a machine without any ROS.

The node is in the graph for its parameters and its log only.
"""

import math
from typing import Any

import rclpy
import roslibpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node

from simconsole_controllers.pursuit import Pursuit

CONNECT_S = 60.0  # a console that is started beside it compiles first
STANDSTILL_MPS = 0.1  # as in the console; a car that has moved is hardly ever at 0 to the last digit again


class RosbridgeController(Node):
    """Answers each odometry with a speed and a yaw rate that carry its stamp."""

    def __init__(self) -> None:
        """Declare the parameters and connect; roslibpy comes back by itself when the console is started anew.

        Raises:
            roslibpy.core.RosTimeoutError: nobody serves rosbridge there.
        """
        super().__init__("rosbridge_controller")
        host, port = self.declare_parameter("host", "127.0.0.1").value, self.declare_parameter("port", 9090).value
        namespace = self.declare_parameter("namespace", "").value
        self._speed_mps = self.declare_parameter("speed_mps", 8.0).value
        self._lateral_accel_mps2 = self.declare_parameter("lateral_accel_mps2", 2.0).value
        self._asks = self.declare_parameter("ask_for_autonomy", True).value
        self._pursuit: Pursuit | None = None
        self.get_logger().info(f"connecting to {host}:{port}")
        self._ros = roslibpy.Ros(host, port)
        self._ros.run(timeout=CONNECT_S)
        self._commands = roslibpy.Topic(self._ros, f"{namespace}/cmd_vel_stamped", "geometry_msgs/TwistStamped")
        self._requests = roslibpy.Topic(self._ros, f"{namespace}/console/request", "std_msgs/String")
        self._route = roslibpy.Topic(self._ros, f"{namespace}/route", "nav_msgs/Path")
        self._odometry = roslibpy.Topic(self._ros, f"{namespace}/odom", "nav_msgs/Odometry")
        self._commands.advertise()
        self._requests.advertise()
        self._route.subscribe(self._follow)
        self._odometry.subscribe(self._answer)

    def close(self) -> None:
        """Leave the console; it stops the car."""
        self._ros.close()

    def _follow(self, route: dict[str, Any]) -> None:
        points_m = [(each["pose"]["position"]["x"], each["pose"]["position"]["y"]) for each in route["poses"]]
        if len(points_m) < 3:
            self.get_logger().error("the console's world has no course: there is no route to follow")
            return
        self._pursuit = Pursuit(points_m, self._speed_mps, self._lateral_accel_mps2)
        self.get_logger().info(f"following a route of {len(points_m)} points")

    def _answer(self, odometry: dict[str, Any]) -> None:
        if self._pursuit is None:
            return
        position, turn = odometry["pose"]["pose"]["position"], odometry["pose"]["pose"]["orientation"]
        yaw_rad = 2.0 * math.atan2(turn["z"], turn["w"])
        speed_mps, yaw_rate_radps = self._pursuit.command(position["x"], position["y"], yaw_rad)
        header = {"stamp": odometry["header"]["stamp"], "frame_id": "base_link"}
        twist = {"linear": {"x": speed_mps}, "angular": {"z": yaw_rate_radps}}
        self._commands.publish(roslibpy.Message({"header": header, "twist": twist}))
        if self._asks and abs(odometry["twist"]["twist"]["linear"]["x"]) < STANDSTILL_MPS:
            self._requests.publish(roslibpy.Message({"data": "autonomous"}))


def main() -> None:
    """Run until it is interrupted."""
    rclpy.init()
    controller = RosbridgeController()
    try:
        rclpy.spin(controller)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        controller.close()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
