"""Drive through the ROS 2 graph: the console runs with --ros2 and is a node beside this one."""

import math

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry, Path
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from simconsole_controllers.pursuit import Pursuit

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
STANDSTILL_MPS = 0.1  # as in the console; a car that has moved is hardly ever at 0 to the last digit again


class GraphController(Node):
    """Answers each odometry with a speed and a yaw rate that carry its stamp."""

    def __init__(self) -> None:
        """Declare the parameters; wait for the route."""
        super().__init__("graph_controller")
        namespace = self.declare_parameter("namespace", "").value
        self._speed_mps = self.declare_parameter("speed_mps", 8.0).value
        self._lateral_accel_mps2 = self.declare_parameter("lateral_accel_mps2", 2.0).value
        self._asks = self.declare_parameter("ask_for_autonomy", True).value
        self._pursuit: Pursuit | None = None
        self._commands = self.create_publisher(TwistStamped, f"{namespace}/cmd_vel_stamped", 10)
        self._requests = self.create_publisher(String, f"{namespace}/console/request", 10)
        self.create_subscription(Path, f"{namespace}/route", self._follow, LATCHED)
        self.create_subscription(Odometry, f"{namespace}/odom", self._answer, 10)
        self.get_logger().info(f"waiting for {namespace}/route")

    def _follow(self, route: Path) -> None:
        points_m = [(pose.pose.position.x, pose.pose.position.y) for pose in route.poses]
        if len(points_m) < 3:
            self.get_logger().error("the console's world has no course: there is no route to follow")
            return
        self._pursuit = Pursuit(points_m, self._speed_mps, self._lateral_accel_mps2)
        self.get_logger().info(f"following a route of {len(points_m)} points")

    def _answer(self, odometry: Odometry) -> None:
        if self._pursuit is None:
            return
        pose = odometry.pose.pose
        yaw_rad = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        command = TwistStamped()
        command.header.stamp = odometry.header.stamp
        command.header.frame_id = "base_link"
        command.twist.linear.x, command.twist.angular.z = self._pursuit.command(
            pose.position.x, pose.position.y, yaw_rad
        )
        self._commands.publish(command)
        if self._asks and abs(odometry.twist.twist.linear.x) < STANDSTILL_MPS:
            self._requests.publish(String(data="autonomous"))


def main() -> None:
    """Run until it is interrupted."""
    rclpy.init()
    try:
        rclpy.spin(GraphController())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
