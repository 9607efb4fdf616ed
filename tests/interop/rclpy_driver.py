"""An ordinary rclpy node that drives: answers each /odom by a /cmd_vel_stamped with its stamp, then says what it saw.

`python rclpy_driver.py SECONDS`: ends when the odometry's stamp has come so far.
"""

import json
import math
import sys
import time

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import String

SPEED_MPS = 8.0


class Driver(Node):  # type: ignore[misc]  # rclpy has no types here
    def __init__(self, seconds: float) -> None:
        super().__init__("driver")
        self._seconds = seconds
        self._commands = self.create_publisher(TwistStamped, "/cmd_vel_stamped", 10)
        self._requests = self.create_publisher(String, "/console/request", 10)
        self.answers = 0
        self.x_m = 0.0
        self.y_m = 0.0
        self.wall_s = 0.0
        self.finished = False

    def begin(self) -> None:
        """Begin once the console hears."""
        while not self._commands.get_subscription_count() or not self._requests.get_subscription_count():
            time.sleep(0.02)
        self._began_s = time.monotonic()
        self.create_subscription(Odometry, "/odom", self._answer, 10)

    def _answer(self, odometry: Odometry) -> None:
        position = odometry.pose.pose.position
        self.x_m, self.y_m = position.x, position.y
        command = TwistStamped()
        command.header.stamp = odometry.header.stamp
        command.header.frame_id = "base_link"
        command.twist.linear.x = SPEED_MPS
        turn = odometry.pose.pose.orientation
        heading_rad = 2.0 * math.atan2(turn.z, turn.w)
        # Towards y = 3 m and along x, well damped: where it is at the end is no matter of the moment.
        command.twist.angular.z = -0.05 * (position.y - 3.0) - 0.8 * heading_rad
        self._commands.publish(command)
        self.answers += 1
        if self.answers % 50 == 10:  # granted to who commands already
            self._requests.publish(String(data="autonomous"))
        self.wall_s = time.monotonic() - self._began_s
        self.finished = odometry.header.stamp.sec + odometry.header.stamp.nanosec * 1e-9 >= self._seconds


def main() -> None:
    rclpy.init()
    driver = Driver(float(sys.argv[1]))
    driver.begin()
    while not driver.finished:
        rclpy.spin_once(driver, timeout_sec=10.0)
    print(json.dumps({"answers": driver.answers, "x_m": driver.x_m, "y_m": driver.y_m, "wall_s": driver.wall_s}))


if __name__ == "__main__":
    main()
