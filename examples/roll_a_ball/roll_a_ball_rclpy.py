"""Roll a ball from the ROS side, as a node of ROS 2. `--keys`: by the arrow keys. Ends when nothing comes for 5 s."""

import sys
import time

import rclpy
from game import SPEED_MPS, Game
from geometry_msgs.msg import PoseStamped
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64, String

rclpy.init()
node, game = rclpy.create_node("roll_a_ball"), Game("--keys" in sys.argv)
speed = node.create_publisher(Float64, "/ball/desired_speed", 10)
pose = node.create_publisher(PoseStamped, "/ball/desired_pose", 10)
request = node.create_publisher(String, "/console/request", 10)


def answer(message: Odometry) -> None:
    """Answer the ball's pose with the pose that it shall roll to; in lockstep the console waits for this."""
    now, goal = message.pose.pose.position, PoseStamped()
    goal.header.stamp, goal.header.frame_id = message.header.stamp, "map"
    goal.pose.position.x, goal.pose.position.y = game.roll(now.x, now.y)
    goal.pose.orientation.w = 1.0
    pose.publish(goal)
    if game.poses in (10, 30, 50):  # who commands may ask to drive; once granted, asking again changes nothing
        request.publish(String(data="autonomous"))


while not all(topic.get_subscription_count() for topic in (speed, pose, request)):
    time.sleep(0.05)  # until the console hears
speed.publish(Float64(data=SPEED_MPS))
node.create_subscription(Odometry, "/odom", answer, 10)
seen = -1
while game.poses > seen:
    seen, until = game.poses, time.monotonic() + 5.0
    while game.poses == seen and time.monotonic() < until:
        rclpy.spin_once(node, timeout_sec=0.5)
print(f"the drive has ended, {len(game.left)} cubes are left")
