"""A program that nobody here wrote the library of: drives a robot with stock roslibpy, then says what it heard.

Run as a process of its own (its reactor can be started once): `python turtlebot_client.py PORT SECONDS`. It turns in
place, then drives straight ahead until the end.
"""

import json
import sys
import threading
from collections import Counter
from typing import Any

import roslibpy

TYPES = {
    "/scan": "sensor_msgs/LaserScan",
    "/imu": "sensor_msgs/Imu",
    "/joint_states": "sensor_msgs/JointState",
    "/battery_state": "sensor_msgs/BatteryState",
    "/sensor_state": "turtlebot3_msgs/SensorState",
    "/magnetic_field": "sensor_msgs/MagneticField",
    "/tf": "tf2_msgs/TFMessage",
    "/tf_static": "tf2_msgs/TFMessage",
    "/console/mode": "std_msgs/String",
    "/odom": "nav_msgs/Odometry",
}
TURN_S = 2.0


def main(port: int, seconds: float) -> None:
    ros = roslibpy.Ros("127.0.0.1", port)
    ros.run(timeout=120)
    heard: Counter[str] = Counter()
    last: dict[str, Any] = {}
    most_bumped = 0
    done = threading.Event()
    drive = roslibpy.Topic(ros, "/cmd_vel", "geometry_msgs/Twist")
    request = roslibpy.Topic(ros, "/console/request", "std_msgs/String")
    drive.advertise()
    request.advertise()

    def listen(topic: str) -> None:
        def received(message: dict[str, Any]) -> None:
            nonlocal most_bumped
            heard[topic] += 1
            last[topic] = message
            if topic == "/sensor_state":
                most_bumped = max(most_bumped, message["bumper"])
            if topic == "/odom":
                answer(message)

        roslibpy.Topic(ros, topic, TYPES[topic]).subscribe(received)

    def answer(message: dict[str, Any]) -> None:
        stamp = message["header"]["stamp"]
        time_s = stamp["sec"] + 1e-9 * stamp["nanosec"]
        if last.get("/console/mode", {}).get("data") != "AUTONOMOUS" and heard["/odom"] % 10 == 0:
            request.publish(roslibpy.Message({"data": "autonomous"}))
        turning = time_s < TURN_S
        linear = {"x": 0.0 if turning else 0.2, "y": 0.0, "z": 0.0}
        angular = {"x": 0.0, "y": 0.0, "z": 1.0 if turning else 0.0}
        drive.publish(roslibpy.Message({"linear": linear, "angular": angular}))
        if time_s >= seconds - 0.5:
            done.set()

    for topic in TYPES:
        listen(topic)
    finished = done.wait(120.0)
    ros.close()
    print(json.dumps({"finished": finished, "heard": heard, "last": last, "bumped": most_bumped}))


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]))
