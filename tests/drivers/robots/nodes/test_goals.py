import math
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.protocol import client_protocol
from simconsole.bridge.protocol.client_protocol import ClientProtocol
from simconsole.drivers.robots.navigation.navigator import Navigator, Progress
from simconsole.drivers.robots.nodes.goals import ACTION, Goals
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Pose
from tests.drivers.robots.arena_robot import burger
from tests.drivers.robots.navigation.rooms import two_rooms

HERE = Pose(1.0, 1.0, 0.0)


class Sent:
    """A goal of the action, and what its sender hears."""

    def __init__(self, args: Any) -> None:
        self.protocol = ClientProtocol()
        self.goal = client_protocol.Goal(self.protocol, ACTION, "g1", args)

    def heard(self) -> list[dict[str, Any]]:
        import json

        found = [json.loads(text) for text in self.protocol.replies]
        self.protocol.replies.clear()
        return found


def to(x: float, y: float, frame: str = "map") -> dict[str, Any]:
    pose = {"position": {"x": x, "y": y, "z": 0.0}, "orientation": {"z": math.sin(0.25), "w": math.cos(0.25)}}
    return {"pose": {"header": {"frame_id": frame}, "pose": pose}}


@pytest.fixture
def navigator() -> Navigator:
    made = Navigator(burger(), compiled)
    made.see_map(two_rooms())
    return made


def test_a_goal_of_the_action_is_told_of_and_ends_with_a_result(navigator: Navigator) -> None:
    goals, sent = Goals(navigator), Sent(to(1.5, 1.0))
    goals.pursue(sent.goal)
    assert navigator.goal is not None
    assert navigator.goal[:3] == pytest.approx((1.5, 1.0, 0.5))
    goals.report(10.0, HERE)
    assert sent.heard() == []
    navigator.steer(11.0, HERE, np.empty((0, 2)))
    goals.report(11.5, HERE)
    (feedback,) = sent.heard()
    assert feedback["op"] == "action_feedback"
    assert feedback["values"]["distance_remaining"] == pytest.approx(0.5, abs=0.05)
    assert feedback["values"]["navigation_time"] == {"sec": 1, "nanosec": 500_000_000}
    navigator.progress = Progress.REACHED
    goals.report(12.0, HERE)
    (result,) = sent.heard()
    assert (result["op"], result["result"], result["values"]["error_code"]) == ("action_result", True, 0)
    goals.report(13.0, HERE)
    assert sent.heard() == []


def test_a_cancelled_goal_stops_the_robot(navigator: Navigator) -> None:
    goals, sent = Goals(navigator), Sent(to(1.5, 1.0))
    goals.pursue(sent.goal)
    sent.goal.cancelled = True
    goals.report(1.0, HERE)
    assert navigator.goal is None
    (result,) = sent.heard()
    assert not result["result"]


def test_a_goal_that_cannot_be_reached_fails_and_a_newer_one_takes_its_place(navigator: Navigator) -> None:
    goals, first, second = Goals(navigator), Sent(to(1.5, 1.0)), Sent(to(0.5, 1.0))
    goals.pursue(first.goal)
    goals.pursue(second.goal)
    assert [one["result"] for one in first.heard()] == [False]
    navigator.progress = Progress.FAILED
    goals.report(1.0, HERE)
    assert [one["result"] for one in second.heard()] == [False]


@pytest.mark.parametrize(
    "args", [{}, {"pose": {}}, {"pose": {"pose": {"position": {"x": "a", "y": 1}}}}, None, to(1.0, 1.0, "odom")]
)
def test_a_goal_that_says_nothing_is_refused(navigator: Navigator, args: Any) -> None:
    goals, sent = Goals(navigator), Sent(args)
    goals.pursue(sent.goal)
    assert navigator.goal is None
    assert [one["result"] for one in sent.heard()] == [False]


def test_no_goal_from_outside_is_taken_while_a_mission_is_under_way(navigator: Navigator) -> None:
    goals, sent = Goals(navigator, is_open=False), Sent(to(1.5, 1.0))
    goals.pursue(sent.goal)
    assert navigator.goal is None
    assert [one["result"] for one in sent.heard()] == [False]
