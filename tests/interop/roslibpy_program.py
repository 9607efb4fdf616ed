"""A program that nobody here wrote the library of: drives the console with stock roslibpy, then says what it saw.

Run as a process of its own (its reactor can be started once): `python roslibpy_program.py PORT ANSWERS`.
"""

import json
import sys
import threading
from typing import Any

import roslibpy

PATIENCE_S = 600.0  # of tests/patience.py, which this program cannot import: it ends only what hangs
CONTROL = "/control/command/control_cmd"


def main(port: int, answers: int) -> None:
    ros = roslibpy.Ros("127.0.0.1", port)
    ros.run(timeout=PATIENCE_S)
    seen: list[dict[str, Any]] = []
    done = threading.Event()
    control = roslibpy.Topic(ros, CONTROL, "autoware_control_msgs/Control")
    twist = roslibpy.Topic(ros, "/cmd_vel", "geometry_msgs/Twist")
    odometry = roslibpy.Topic(ros, "/odom", "nav_msgs/Odometry")
    control.advertise()
    twist.advertise()

    def answer(message: dict[str, Any]) -> None:
        seen.append(message)
        if len(seen) < answers:
            lateral = {"steering_tire_angle": message["pose"]["pose"]["position"]["x"] / 1000.0}
            command = {"stamp": message["header"]["stamp"], "lateral": lateral, "longitudinal": {"acceleration": 0.5}}
            control.publish(roslibpy.Message(command))
        else:
            twist.publish(roslibpy.Message({"linear": {"x": 2.5, "y": 0.0, "z": 0.0}, "angular": {"z": 0.25}}))

    # An accepted command is passed on to whoever watches its topic: then it has arrived.
    watched = roslibpy.Topic(ros, "/cmd_vel", "geometry_msgs/Twist")
    watched.subscribe(lambda message: done.set())
    odometry.subscribe(answer)
    finished = done.wait(PATIENCE_S)
    odometry.unsubscribe()
    watched.unsubscribe()
    control.unadvertise()
    twist.unadvertise()
    ros.close()
    print(json.dumps({"finished": finished, "positions": [each["pose"]["pose"]["position"]["x"] for each in seen]}))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
