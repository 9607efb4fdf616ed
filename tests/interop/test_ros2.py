"""A real ROS 2, rclpy over DDS on loopback, meets the console with no rosbridge_server between."""

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from simconsole.cli.main import main
from tests.interop.programs import HERE, Client, client, console, program
from tests.interop.ros2 import PYTHON, domain, needs_ros2
from tests.interop.sessions import lockstep_session
from tests.paths import ROOT
from tests.patience import PATIENCE_S
from tests.samples import Sample

pytestmark = needs_ros2

FIBONACCI = "test_msgs/action/Fibonacci"
SUCCEEDED, CANCELED = 4, 5


def test_an_rclpy_node_drives(tmp_path: Path, sample: Sample, record_property: Callable[[str, object], None]) -> None:
    seconds = sample.of(15, 60)
    bundle = tmp_path / "bundle"
    around = domain()
    words = [
        PYTHON,
        "-m",
        "simconsole",
        "drive",
        lockstep_session(tmp_path, 0, seconds, ros2=True),
        "--out",
        str(bundle),
        "--no-pack",
        "--json",
    ]
    with (
        program(around, *words) as drive,
        program(around, PYTHON, str(HERE / "rclpy_driver.py"), str(seconds)) as driver,
    ):
        told, complaint = driver.communicate(timeout=PATIENCE_S)
        assert driver.returncode == 0, complaint
        output, complaint = drive.communicate(timeout=PATIENCE_S)
        assert drive.returncode == 0, complaint
    results, seen = json.loads(output.splitlines()[-1]), json.loads(told)
    assert (results["unanswered"], results["exchanges"]) == (0, 50 * seconds)
    assert seen["answers"] == 50 * seconds
    assert results["duration_s"] == pytest.approx(seconds, abs=0.1)
    assert results["distance_m"] > 8.0 * seconds - 70.0  # at 8 m/s, but for the start
    assert seen["x_m"] > 8.0 * seconds - 70.0
    assert 2.5 < seen["y_m"] < 3.5  # it steered to 3, from 0
    assert main(["replay", str(bundle)]) == 0
    record_property("rclpy in lockstep", f"{seconds} s driven in {seen['wall_s']:.1f} s, 50 Hz control over DDS")


def test_a_node_commands_in_real_time_and_vanishes() -> None:
    around = domain()
    with (
        console(PYTHON, around, "--ros2") as url,
        client(url) as watcher,
        program(around, PYTHON, str(HERE / "rclpy_driver.py"), "1e9") as driver,
    ):
        watcher.say(op="subscribe", topic="/vehicle/status/velocity_status")
        watcher.hear(lambda heard: heard["msg"]["longitudinal_velocity"] > 3.0)
        driver.kill()
        watcher.hear(lambda heard: heard["msg"]["longitudinal_velocity"] < 0.1)


def test_the_node_in_the_documentation_drives(tmp_path: Path) -> None:
    page = (ROOT / "docs/ros2.md").read_text()
    (example,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    path = tmp_path / "driver.py"
    path.write_text(example)
    around = domain()
    with (
        console(PYTHON, around, "--ros2") as url,
        client(url) as watcher,
        program(around, PYTHON, str(path)),
    ):
        watcher.say(op="subscribe", topic="/cmd_vel")  # accepted commands go to who watches them
        assert watcher.message("/cmd_vel")["linear"]["x"] == 5.0
        watcher.say(op="subscribe", topic="/odom")
        watcher.hear(lambda heard: heard["topic"] == "/odom" and heard["msg"]["twist"]["twist"]["linear"]["x"] > 4.5)


def test_without_rclpy_it_says_so_at_once(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bridge", "serve", "--ros2", "--for", "1"]) == 2
    assert "there is no rclpy; pip install 'simconsole[ros2]'" in capsys.readouterr().err


@pytest.fixture(scope="module")
def met() -> Iterator[Client]:
    """A rosbridge client of a console that has joined a graph with a peer in it: below all that can do without."""
    around = domain()
    with (
        console(PYTHON, around, "--ros2") as url,
        program(around, PYTHON, str(HERE / "rclpy_peer.py")) as peer,
        client(url) as made,
    ):
        made.say(op="subscribe", topic="/ros/says", type="std_msgs/String", queue_length=100)
        yield made
        assert peer.poll() is None


def said(client: Client, text: str) -> None:
    client.hear(lambda heard: heard.get("topic") == "/ros/says" and heard["msg"]["data"] == text)


def test_topics_of_the_graph(met: Client) -> None:
    met.say(op="subscribe", topic="/ros/scan", type="sensor_msgs/LaserScan")
    met.say(op="subscribe", topic="/ros/latched", type="std_msgs/String")
    assert met.message("/ros/latched") == {"data": "once"}  # published before anyone here asked
    assert met.message("/ros/scan")["ranges"] == [1.0, None, 2.0]  # by a best-effort publisher
    met.say(op="unsubscribe", topic="/ros/scan")
    met.say(op="unsubscribe", topic="/ros/latched")


def test_time_and_odometry_reach_the_graph(met: Client) -> None:
    said(met, "saw clock")  # by a best-effort subscriber
    said(met, "saw odometry")


def test_topics_of_clients(met: Client) -> None:
    met.say(op="advertise", topic="/web/talk", type="std_msgs/String")
    met.say(op="subscribe", topic="/web/talk")
    for number in range(200):
        met.say(op="publish", topic="/web/talk", msg={"data": str(number)})
        assert met.message("/web/talk") == {"data": str(number)}  # once: the graph does not send it back
        try:
            heard = json.loads(met.web.recv(timeout=0.05))
        except TimeoutError:
            continue
        assert heard["topic"] == "/ros/says"
        if heard["msg"]["data"].startswith("heard "):
            break
    else:
        pytest.fail("the peer has heard nothing")
    met.say(op="unadvertise", topic="/web/talk")
    met.say(op="unsubscribe", topic="/web/talk")


def test_a_service_of_the_graph(met: Client) -> None:
    services: list[str] = []
    while "/ros/flip" not in services:  # found within a moment
        met.say(op="call_service", id="list", service="/rosapi/services")
        services = met.hear(lambda heard: heard.get("id") == "list")["values"]["services"]
    for number in range(5):
        met.say(op="call_service", id=number, service="/ros/flip", args={"data": bool(number % 2)})
    answers = met.answers(5)
    assert [answers[number]["success"] for number in range(5)] == [True, False, True, False, True]


def test_an_action_of_the_graph(met: Client) -> None:
    servers: list[str] = []
    while "/ros/fibonacci" not in servers:
        met.say(op="call_service", id="list", service="/rosapi/action_servers")
        servers = met.hear(lambda heard: heard.get("id") == "list")["values"]["action_servers"]
    goal = {"op": "send_action_goal", "action": "/ros/fibonacci", "action_type": FIBONACCI, "feedback": True}
    met.say(**goal, id="short", args={"order": 4})
    feedback = met.hear(lambda heard: heard.get("id") == "short")
    assert (feedback["op"], feedback["values"]["sequence"][:2]) == ("action_feedback", [0, 1])
    result = met.hear(lambda heard: heard["op"] == "action_result")
    assert (result["status"], result["values"]["sequence"]) == (SUCCEEDED, [0, 1, 1, 2, 3])
    met.say(**goal, id="long", args={"order": 40})
    met.hear(lambda heard: heard.get("id") == "long")
    met.say(op="cancel_action_goal", action="/ros/fibonacci", id="long")
    result = met.hear(lambda heard: heard["op"] == "action_result")
    assert (result["id"], result["status"]) == ("long", CANCELED)


def test_services_and_actions_of_clients(met: Client) -> None:
    met.say(op="advertise_service", service="/web/flip", type="std_srvs/srv/SetBool")
    met.say(op="advertise_action", action="/web/fibonacci", type=FIBONACCI)
    call = met.hear(lambda heard: heard["op"] == "call_service")
    assert call["args"] == {"data": True}
    values = {"success": False, "message": "no"}
    met.say(op="service_response", service="/web/flip", id=call["id"], values=values, result=True)
    goal = met.hear(lambda heard: heard["op"] == "send_action_goal")
    assert goal["args"] == {"order": 3}
    told = {"action": "/web/fibonacci", "id": goal["id"]}
    met.say(op="action_feedback", values={"sequence": [0, 1]}, **told)
    met.say(op="action_result", values={"sequence": [0, 1, 1, 2]}, status=SUCCEEDED, result=True, **told)
    wanted = {"flip False no", "feedback [0, 1]", "result 4 [0, 1, 1, 2]"}
    while wanted:
        wanted.discard(met.message("/ros/says")["data"])
