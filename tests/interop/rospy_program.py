"""An ordinary rospy node: drives by a message type of its own making, serves, calls, and says what it saw.

`python3 rospy_program.py MESSAGES`: the folder of the packages made by genpy.
"""

import json
import sys
import threading
from typing import Any

sys.path.insert(0, sys.argv[1])

import rospy  # found only now
from ackermann_msgs.msg import AckermannDriveStamped
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolResponse

PATIENCE_S = 600.0  # of tests/patience.py, which this program cannot import: it ends only what hangs

seen: dict[str, Any] = {"odometry": 0}
fast = threading.Event()


def answer(odometry: Any) -> None:
    seen["odometry"] += 1
    command = AckermannDriveStamped()
    command.header.stamp = odometry.header.stamp
    command.drive.speed = 6.0
    command.drive.steering_angle = 0.01
    commands.publish(command)
    if seen["odometry"] % 25 == 10:
        requests.publish("autonomous")
    if odometry.twist.twist.linear.x > 3.0:
        seen.update(frame=odometry.header.frame_id, covariance=len(odometry.pose.covariance))
        fast.set()


rospy.init_node("driver", disable_signals=True)
commands = rospy.Publisher("/ackermann_cmd", AckermannDriveStamped, queue_size=1)
requests = rospy.Publisher("/console/request", String, queue_size=1)
rospy.Service("/ros1/flip", SetBool, lambda request: SetBoolResponse(not request.data, "flipped"))
rospy.Subscriber("/odom", Odometry, answer)
rospy.wait_for_service("/web/flip", timeout=PATIENCE_S)
response = rospy.ServiceProxy("/web/flip", SetBool)(True)
seen["flip"] = [response.success, response.message]
seen["fast"] = fast.wait(PATIENCE_S)
print(json.dumps(seen), flush=True)
sys.stdin.read()
