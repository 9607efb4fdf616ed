import math
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.plan_input import ADVICE, PLAN
from simconsole.bridge.console.surroundings import NOWHERE
from simconsole.bridge.protocol.access import Role
from simconsole.bridge.protocol.operations import write_publish
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.planned_path import MOST_PLACES, PlannedPath


class Told:
    """A console, a client of it, and the plans that the console was told."""

    def __init__(self, profile: BridgeProfile | None = None, role: Role = Role.CONTROL) -> None:
        self.plans: list[PlannedPath] = []
        self.bridge = ConsoleBridge(profile or BridgeProfile(), on_plan=self.plans.append)
        self.session = self.bridge.router.connect("planner", role=role)

    def say(self, message: dict[str, Any], topic: str = PLAN) -> Any:
        return self.bridge.receive(self.session, write_publish(topic, message), 0)


def path(count: int = 2, frame: str = "map", x_m: float = 0.0, **position: Any) -> dict[str, Any]:
    poses = [
        {
            "header": {"stamp": {"sec": 5 + number // 4, "nanosec": 250_000_000 * (number % 4)}},
            "pose": {"position": {"x": x_m + number, "y": -1.0, "z": 0.5, **position}},
        }
        for number in range(count)
    ]
    return {"header": {"frame_id": frame, "stamp": {"sec": 5}}, "poses": poses}


def test_a_plan_comes_with_the_console_s_own_time_whatever_clock_its_sender_has(snapshot: Any) -> None:
    told = Told()
    told.bridge.publish(snapshot(250), 0)
    assert told.say(path(3)).kind == "command"
    (plan,) = told.plans
    assert plan.t_ns == snapshot(250).t_ns
    np.testing.assert_array_equal(plan.places, [(0.0, 0.0, -1.0, 0.5), (0.25, 1.0, -1.0, 0.5), (0.5, 2.0, -1.0, 0.5)])


def test_a_plan_commands_nothing_and_needs_no_lease(snapshot: Any) -> None:
    told = Told()
    assert told.say(path()).kind == "command"
    assert told.bridge.inputs.command.sequence == 0.0
    assert told.bridge.router.desk.lease.holder(0) is None


def test_no_plan_is_one_without_places() -> None:
    told = Told()
    assert told.say({"header": {"frame_id": "map"}, "poses": []}).kind == "command"
    assert told.plans[0].places.shape == (0, 4)


def test_of_many_places_the_first_the_last_and_some_between_are_kept() -> None:
    told = Told()
    assert told.say(path(1000)).kind == "command"
    x_m = told.plans[0].places[:, 1]
    assert len(x_m) == MOST_PLACES
    assert (x_m[0], x_m[-1]) == (0.0, 999.0)
    assert (np.diff(x_m) > 0.0).all()


def test_faster_ones_than_twenty_a_second_are_passed_over(snapshot: Any) -> None:
    told = Told()
    for tick in range(1, 251):
        told.bridge.publish(snapshot(tick), 0)
        assert told.say(path()).kind == "command"
    assert 18 <= len(told.plans) <= 20
    told.bridge.publish(snapshot(1), 0)
    told.say(path())
    assert told.plans[-1].t_ns == snapshot(1).t_ns, "after a restart, too"


@pytest.mark.parametrize(
    ("message", "said"),
    [(path(frame="base_link"), "'base_link' is not map"), (path(x=None), "got `null`"), (path(x="a"), "x")],
)
def test_what_is_no_plan_is_refused_in_words_and_kept_from_nobody_else(message: dict[str, Any], said: str) -> None:
    told = Told()
    outcome = told.say(message)
    assert outcome.kind != "command"
    assert said in outcome.text
    assert told.plans == []
    assert told.say(path()).kind == "command"


def test_who_may_only_watch_plans_nothing() -> None:
    told = Told(role=Role.PUBLISH)
    assert "this needs the role control" in told.say(path()).text
    assert told.plans == []


def test_its_name_is_as_the_profile_has_it_and_other_clients_hear_it() -> None:
    told = Told(BridgeProfile(namespace="/ego", rename={PLAN: "/planning/trajectory"}))
    listener = told.bridge.router.connect("viewer", role=Role.VIEW)
    told.bridge.receive(listener, b'{"op":"subscribe","topic":"/planning/trajectory"}', 0)
    assert told.say(path(), "/planning/trajectory").kind == "command"
    assert len(told.plans) == 1
    assert b'"poses"' in (listener.next_text(0) or b"")


def test_a_node_of_a_graph_plans_too_and_what_is_not_finite_is_refused() -> None:
    told = Told()
    assert told.bridge.receive_plain(told.session, PLAN, path(), 0).kind == "command"
    refused = told.bridge.receive_plain(told.session, PLAN, path(x=math.nan), 0)
    assert "not finite" in refused.text
    assert len(told.plans) == 1


def test_advice_of_a_controller_is_taken_and_what_is_none_is_refused_in_words() -> None:
    told = list[str]()

    def take(text: str) -> None:
        if text == "drive on":
            raise ValueError("that is no advice")
        told.append(text)

    bridge = ConsoleBridge(BridgeProfile(), around=NOWHERE._replace(on_advice=take))
    session = bridge.router.connect("controller", role=Role.CONTROL)
    refused, taken = (
        bridge.receive(session, write_publish(ADVICE, {"data": text}), 0) for text in ("drive on", '{"kind": 2}')
    )
    assert "that is no advice" in refused.text
    assert taken.kind == "command"
    assert told == ['{"kind": 2}']
    assert bridge.router.desk.lease.holder(0) is None, "it commands nothing"


def test_advice_that_nobody_asked_for_is_let_pass() -> None:
    assert Told().say({"data": "{}"}, topic=ADVICE).kind == "command"
