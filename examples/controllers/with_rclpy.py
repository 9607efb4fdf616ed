"""Drive as a node of ROS 2: /route and /odom in, /cmd_vel_stamped out. Ends when nothing comes for 5 s."""

import math
import time

import rclpy
from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry, Path
from pursuit import SPEED_MPS, Pursuit
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("controller")
commands = node.create_publisher(TwistStamped, "/cmd_vel_stamped", 10)
requests = node.create_publisher(String, "/console/request", 10)
pursuit, answers = Pursuit([]), 0


def begin(path: Path) -> None:
    """Learn the route, which the console tells once, as the drive begins."""
    global pursuit
    pursuit = Pursuit([(pose.pose.position.x, pose.pose.position.y) for pose in path.poses])


def answer(odometry: Odometry) -> None:
    """Answer a pose by a command with its stamp."""
    global answers
    position, turn = odometry.pose.pose.position, odometry.pose.pose.orientation
    command = TwistStamped()
    command.header.stamp, command.header.frame_id = odometry.header.stamp, "base_link"
    command.twist.linear.x = SPEED_MPS
    command.twist.angular.z = pursuit.turn_rate(position.x, position.y, 2.0 * math.atan2(turn.z, turn.w))
    commands.publish(command)
    answers += 1
    if answers in (10, 30, 50):  # granted to who commands already
        requests.publish(String(data="autonomous"))


while not (commands.get_subscription_count() and requests.get_subscription_count()):
    time.sleep(0.05)  # until the console hears
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
node.create_subscription(Path, "/route", begin, latched)
node.create_subscription(Odometry, "/odom", answer, 10)
seen = -1
while answers > seen:
    seen, until = answers, time.monotonic() + (5.0 if answers else 60.0)
    while answers == seen and time.monotonic() < until:
        rclpy.spin_once(node, timeout_sec=0.5)
print(f"the drive has ended after {answers} answers")
