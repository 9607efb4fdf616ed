"""The autopilot over a real WebSocket, against a small server that knows nothing of simconsole's own."""

import json
import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from websockets.sync.server import ServerConnection, serve

from simconsole.drivers.autopilot.rosbridge_autopilot import run
from simconsole.values.errors import BridgeError, ProfileError
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode

WHEELBASE_M = 2.6


def odometry(step: int, x: float, y: float, yaw: float, speed: float | None, yaw_rate: float) -> str:
    stamp = {"sec": step // 50, "nanosec": step % 50 * 20_000_000}
    pose = {
        "position": {"x": x, "y": y, "z": 0.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(yaw / 2), "w": math.cos(yaw / 2)},
    }
    twist = {"linear": {"x": speed, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": yaw_rate}}
    message = {
        "header": {"stamp": stamp, "frame_id": "map"},
        "child_frame_id": "base_link",
        "pose": {"pose": pose, "covariance": [0.0] * 36},
        "twist": {"twist": twist, "covariance": [0.0] * 36},
    }
    return json.dumps({"op": "publish", "topic": "/odom", "msg": message})


def driving(mode: Mode) -> str:
    return json.dumps({"op": "publish", "topic": "/console/mode", "msg": {"data": mode_label(mode)}})


class Server:
    """In lockstep: one odometry out, one command in; the car of a kinematic single-track model."""

    def __init__(self, steps: int, engage_at: int, wishes: int = 3) -> None:
        self.steps, self.engage_at, self.expected = steps, engage_at, wishes
        self.plans: list[tuple[int, dict[str, Any]]] = []  # with the step of the command after which each came
        self.wishes: list[dict[str, Any]] = []
        self.stamps: list[bool] = []
        self.lateral: list[float] = []
        self.failure: BaseException | None = None

    def __call__(self, socket: ServerConnection) -> None:
        try:
            self.drive(socket)
        except BaseException as error:  # noqa: BLE001  # shown by the test, which runs in another thread
            self.failure = error

    def command(self, socket: ServerConnection, step: int) -> dict[str, Any]:
        """Return the next command; plans come between two of them."""
        while (said := json.loads(socket.recv()))["topic"] == "/autopilot/plan":
            self.plans.append((step - 1, said["msg"]))
        command: dict[str, Any] = said["msg"]
        return command

    def drive(self, socket: ServerConnection) -> None:
        while len(self.wishes) < self.expected:
            self.wishes.append(json.loads(socket.recv()))
        x, y, yaw, speed, wheel = 100.0, 0.3, 0.0, 8.0, 0.0
        for step in range(self.steps):
            engaged = step >= self.engage_at
            socket.send(driving(Mode.AUTONOMOUS if engaged else Mode.PARKED))
            socket.send(odometry(step, x, y, yaw, speed, speed * math.tan(wheel) / WHEELBASE_M))
            command = self.command(socket, step)
            self.stamps.append(command["stamp"] == {"sec": step // 50, "nanosec": step % 50 * 20_000_000})
            if engaged:
                wheel += 0.33 * (command["lateral"]["steering_tire_angle"] - wheel)
                speed += 0.02 * command["longitudinal"]["acceleration"]
            x, y = x + 0.02 * speed * math.cos(yaw), y + 0.02 * speed * math.sin(yaw)
            yaw += 0.02 * speed * math.tan(wheel) / WHEELBASE_M
            self.lateral.append(y)
        socket.send(odometry(self.steps, x, y, yaw, None, 0.0))  # null is NaN: must not be answered
        socket.close()


@contextmanager
def serving(handler: Any) -> Iterator[str]:
    with serve(handler, "127.0.0.1", 0, compression=None) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"ws://127.0.0.1:{server.socket.getsockname()[1]}"
        finally:
            server.shutdown()
            thread.join()


def test_every_odometry_gets_one_command_with_its_stamp() -> None:
    server = Server(steps=400, engage_at=50)
    with serving(server) as url:
        results = run(url, "urban")
    assert server.failure is None
    assert server.stamps == [True] * 400
    assert results["commands"] == 400
    assert results["engaged_commands"] == 350
    assert results["skipped"] == 1
    assert "closed by the server" in results["ended"]
    assert abs(server.lateral[-1]) < 0.02  # from 0.3 m beside the path
    assert 40.0 < results["engaged_distance_m"] < 140.0
    assert 0.0 < results["lateral_rms_m"] < results["lateral_max_m"] <= 0.31
    operations = sorted((wish["op"], wish["topic"], wish["type"].replace("/msg/", "/")) for wish in server.wishes)
    assert operations == [
        ("advertise", "/control/command/control_cmd", "autoware_control_msgs/Control"),
        ("subscribe", "/console/mode", "std_msgs/String"),
        ("subscribe", "/odom", "nav_msgs/Odometry"),
    ]


def test_what_it_plans_is_told_now_and_then_and_only_after_the_command() -> None:
    server = Server(steps=101, engage_at=0, wishes=4)
    with serving(server) as url:
        results = run(url, "urban", plan_hz=5.0)
    assert server.failure is None
    assert ("advertise", "/autopilot/plan") in [(wish["op"], wish["topic"]) for wish in server.wishes]
    assert server.stamps == [True] * 101, "plans keep nobody from a command"
    assert [step for step, _ in server.plans] == list(range(0, 100, 10)), "five in each second of the odometry"
    for step, plan in server.plans:
        assert plan["header"] == {"stamp": {"sec": step // 50, "nanosec": step % 50 * 20_000_000}, "frame_id": "map"}
        places = [pose["pose"]["position"] for pose in plan["poses"]]
        assert len(places) == 21
        assert places[0]["x"] == pytest.approx(100.0 + 0.16 * step, abs=2.5)
        assert 40.0 < places[-1]["x"] - places[0]["x"] < 5.0 * 50.0 / 3.6, "between its speed now and the limit"
        assert abs(places[-1]["y"]) < 0.05
    assert server.plans[0][1]["poses"][0]["pose"]["position"]["y"] == pytest.approx(0.3, abs=0.02), "from where it is"
    assert results["commands"] == 101


def test_one_program_drives_a_car_in_each_namespace() -> None:
    """Both stand beside the path: one to its left, one to its right; each is steered back."""
    said: list[dict[str, Any]] = []

    def serve(socket: ServerConnection) -> None:
        for _ in range(6):  # of each car an advertised topic and two subscriptions
            socket.recv()
        for step in range(20):
            for namespace, y in (("/left", 0.3), ("/right", -0.3)):
                socket.send(odometry(step, 100.0, y, 0.0, 8.0, 0.0).replace('"/odom"', f'"{namespace}/odom"'))
            said.extend(json.loads(socket.recv()) for _ in range(2))
        socket.close()

    with serving(serve) as url:
        results = run(url, "urban", namespaces=("/left", "/right"))
    assert {car: told["commands"] for car, told in results["cars"].items()} == {"/left": 20, "/right": 20}
    turns = {one["topic"]: one["msg"]["lateral"]["steering_tire_angle"] for one in said}
    assert turns["/left/control/command/control_cmd"] < 0.0 < turns["/right/control/command/control_cmd"]
    assert len(said) == 40


def test_stop_ends_it() -> None:
    asked: list[int] = []
    server = Server(steps=30, engage_at=0)

    def enough() -> bool:
        asked.append(len(asked))
        return len(asked) > 10

    with serving(server) as url:
        results = run(url, "urban", stop=enough)
    assert results["ended"] == "stopped"
    assert results["commands"] <= 10


def test_nobody_there_and_unknown_course_are_one_line() -> None:
    with pytest.raises(BridgeError, match="cannot connect"):
        run("ws://127.0.0.1:1", "urban", patience_s=0.0)
    with pytest.raises(ProfileError, match="worlds profile"):
        run("ws://127.0.0.1:1", "nowhere")
