"""Roll a ball from the ROS side: send desired speed and desired pose, read the current pose.

simconsole drive roll_a_ball --out out/ball        # the console, in one terminal
python examples/roll_a_ball/roll_a_ball.py         # this program, in another
"""

import argparse
import math

from simconsole.bridge.client import BridgeClient
from simconsole.values.errors import BridgeError

WAYPOINTS_M = [(2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)]
SPEED_MPS = 0.8
ARRIVED_M = 0.05
PATIENCE_S = 60.0


def main() -> None:
    """Connect, set the speed, roll."""
    parser = argparse.ArgumentParser(description="Roll a ball round a square, over rosbridge.")
    parser.add_argument("--url", default="ws://127.0.0.1:9090")
    with BridgeClient(parser.parse_args().url, comes_back=False) as client:
        client.advertise("/ball/desired_speed", "std_msgs/Float64")
        client.advertise("/ball/desired_pose", "geometry_msgs/PoseStamped")
        client.advertise("/console/request", "std_msgs/String")
        client.subscribe("/console/arbitration", "simconsole_msgs/Arbitration")
        client.subscribe("/odom", "nav_msgs/Odometry")
        client.connect(PATIENCE_S)  # whoever starts first waits for the other
        client.publish("/ball/desired_speed", {"data": SPEED_MPS})
        try:
            roll(client)
        except BridgeError:
            print("the drive has ended")


def roll(client: BridgeClient) -> None:
    """Answer every pose of the ball with the pose it shall roll to, one waypoint after the other."""
    reached = poses = 0
    while (received := client.receive(30.0)) is not None:
        if received.topic == "/console/arbitration":
            if received.message.mode_words != "AUTONOMOUS" and poses % 25 == 10:
                client.publish("/console/request", {"data": "autonomous"})  # until the console lets us
            continue
        poses += 1
        position, stamp = received.message.pose.pose.position, received.message.header.stamp
        target = WAYPOINTS_M[reached % len(WAYPOINTS_M)]
        if math.dist((position.x, position.y), target) < ARRIVED_M:
            reached += 1
            print(f"{stamp.sec:4d} s  reached {target}, the ball is at ({position.x:.3f}, {position.y:.3f})")
        pose = {"position": {"x": target[0], "y": target[1]}, "orientation": {"w": 1.0}}
        header = {"stamp": {"sec": stamp.sec, "nanosec": stamp.nanosec}, "frame_id": "map"}
        client.publish("/ball/desired_pose", {"header": header, "pose": pose})


if __name__ == "__main__":
    main()
