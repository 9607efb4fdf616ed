"""A real ROS 1, Debian's rospy and rosmaster, meets the console through a small relay; its types are made by genpy."""

import json
import os
import sys
import sysconfig
from pathlib import Path

import pytest

from tests.interop.programs import HERE, client, console, environment, program, wait_for_port
from tests.interop.ros1_packages import PYTHON, make_packages
from tests.ports import free_port

TABLE = {
    "out": {"/odom": "nav_msgs/Odometry", "/clock": "rosgraph_msgs/Clock"},
    "in": {"/ackermann_cmd": "ackermann_msgs/AckermannDriveStamped", "/console/request": "std_msgs/String"},
    "offered": {"/web/flip": "std_srvs/SetBool"},
    "called": {"/ros1/flip": "std_srvs/SetBool"},
}

pytestmark = pytest.mark.skipif(not Path("/usr/bin/rosmaster").exists(), reason="no rosmaster: system-packages.txt")


def test_a_rospy_node_drives_calls_and_serves(tmp_path: Path) -> None:
    master = free_port()
    around = {
        **{name: value for name, value in os.environ.items() if name != "PYTHONPATH"},
        "ROS_MASTER_URI": f"http://127.0.0.1:{master}",
        "ROS_IP": "127.0.0.1",
        "ROS_HOSTNAME": "127.0.0.1",
        "ROS_LOG_DIR": str(tmp_path / "log"),
    }
    messages = str(make_packages(tmp_path / "messages", "ackermann_msgs"))
    with (
        program(around, "/usr/bin/rosmaster", "--core", "-p", str(master)),
        console(sys.executable, environment()) as url,
        client(url) as web,
    ):
        wait_for_port(master)
        web.say(op="advertise_service", service="/web/flip", type="std_srvs/SetBool")
        words = [url, sysconfig.get_path("purelib"), messages, json.dumps(TABLE)]
        with (
            program(around, PYTHON, str(HERE / "ros1_relay.py"), *words),
            program(around, PYTHON, str(HERE / "rospy_program.py"), messages) as node,
        ):
            call = web.hear(lambda heard: heard["op"] == "call_service")
            assert call["args"] == {"data": True}
            values = {"success": False, "message": "no"}
            web.say(op="service_response", service="/web/flip", id=call["id"], values=values, result=True)
            for number in range(4):
                web.say(op="call_service", service="/ros1/flip", id=number, args={"data": bool(number % 2)})
            answers = web.answers(4)
            assert [answers[number]["success"] for number in range(4)] == [True, False, True, False]
            assert node.stdout is not None
            seen = json.loads(node.stdout.readline())
    assert seen["flip"] == [False, "no"]
    assert (seen["fast"], seen["frame"], seen["covariance"]) == (True, "odom", 36)
