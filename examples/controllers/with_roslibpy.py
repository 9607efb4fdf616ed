"""Drive with roslibpy, over rosbridge: /route and /odom in, /cmd_vel_stamped out. `python with_roslibpy.py [PORT]`."""

import math
import sys
import threading
from typing import Any

import roslibpy
from pursuit import SPEED_MPS, Pursuit

ros, ended = roslibpy.Ros("127.0.0.1", int(sys.argv[1]) if len(sys.argv) > 1 else 9090), threading.Event()
ros.run(timeout=60)
ros.on("close", lambda *_: ended.set())
commands = roslibpy.Topic(ros, "/cmd_vel_stamped", "geometry_msgs/TwistStamped")
requests = roslibpy.Topic(ros, "/console/request", "std_msgs/String")
route = roslibpy.Topic(ros, "/route", "nav_msgs/Path")
odometry = roslibpy.Topic(ros, "/odom", "nav_msgs/Odometry")
commands.advertise()
requests.advertise()
pursuit, answers = Pursuit([]), 0


def begin(message: Any) -> None:
    """Learn the route, which the console tells once, as the drive begins."""
    global pursuit
    points = [(pose["pose"]["position"]["x"], pose["pose"]["position"]["y"]) for pose in message["poses"]]
    pursuit = Pursuit(points)


def answer(message: Any) -> None:
    """Answer a pose by a command with its stamp."""
    global answers
    position, turn = message["pose"]["pose"]["position"], message["pose"]["pose"]["orientation"]
    rate = pursuit.turn_rate(position["x"], position["y"], 2.0 * math.atan2(turn["z"], turn["w"]))
    header = {"stamp": message["header"]["stamp"], "frame_id": "base_link"}
    twist = {"linear": {"x": SPEED_MPS, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": rate}}
    answers += 1  # before it is sent: the console may end the drive by the last one, and this program with it
    commands.publish({"header": header, "twist": twist})
    if answers in (10, 30, 50):  # granted to who commands already
        requests.publish({"data": "autonomous"})


route.subscribe(begin)
odometry.subscribe(answer)
ended.wait()
print(f"the drive has ended after {answers} answers")
ros.terminate()
