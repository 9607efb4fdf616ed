"""Roll a ball from the ROS side, with roslibpy over rosbridge. `--keys`: by the arrow keys."""

import argparse
import threading
from typing import Any

import roslibpy
from game import SPEED_MPS, Game

words = argparse.ArgumentParser(description=__doc__)
words.add_argument("--host", default="127.0.0.1")
words.add_argument("--port", type=int, default=9090)
words.add_argument("--keys", action="store_true", help="arrow keys roll the ball")
options = words.parse_args()
game, ended = Game(options.keys), threading.Event()

ros = roslibpy.Ros(options.host, options.port)
ros.run(timeout=60)
ros.on("close", lambda *_: ended.set())  # the console leaves at the end of the drive
speed = roslibpy.Topic(ros, "/ball/desired_speed", "std_msgs/Float64")
pose = roslibpy.Topic(ros, "/ball/desired_pose", "geometry_msgs/PoseStamped")
request = roslibpy.Topic(ros, "/console/request", "std_msgs/String")
odometry = roslibpy.Topic(ros, "/odom", "nav_msgs/Odometry")
for topic in (speed, pose, request):
    topic.advertise()
speed.publish({"data": SPEED_MPS})


def answer(message: Any) -> None:
    """Answer the ball's pose with the pose that it shall roll to; in lockstep the console waits for this."""
    now = message["pose"]["pose"]["position"]
    x_m, y_m = game.roll(now["x"], now["y"])
    header = {"stamp": message["header"]["stamp"], "frame_id": "map"}
    goal = {"position": {"x": x_m, "y": y_m, "z": 0.0}, "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}}
    pose.publish({"header": header, "pose": goal})
    if game.poses in (10, 30, 50):  # who commands may ask to drive; once granted, asking again changes nothing
        request.publish({"data": "autonomous"})


odometry.subscribe(answer)
ended.wait()
print(f"the drive has ended, {len(game.left)} cubes are left")
ros.terminate()
