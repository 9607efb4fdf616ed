"""The operator's acts as a service: events, and the words that no row can hold."""

from collections.abc import Callable
from typing import Any

import msgspec
import pytest

from simconsole.bridge.console.command_decoder import REQUESTS
from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.operator_acts import (
    ACT_BYTES,
    ACTS_MAX,
    ID_CHARS,
    NOTE_CHARS,
    SUMMARY_BYTES,
    Act,
    ActsSummary,
)
from simconsole.bridge.protocol.access import Role
from simconsole.values.signals import Event
from simconsole.values.state_vector import Snapshot
from tests.bridge.fixtures import Peer


def call(peer: Peer, **args: Any) -> tuple[bool, Any]:
    peer.send(op="call_service", service="/console/operate", args=args, id="1")
    (answer,) = [message for message in peer.heard() if message["op"] == "service_response"]
    return answer["result"], answer["values"]


def events(bridge: ConsoleBridge) -> Event:
    return Event(int(bridge.inputs.take(1)[1].events))


@pytest.mark.parametrize("act", REQUESTS)
def test_every_act_of_the_topic_is_an_act_of_the_service(bridge: ConsoleBridge, peer: Peer, act: str) -> None:
    assert call(peer, act=act) == (True, {"accepted": True, "tick": 0})
    assert events(bridge) == REQUESTS[act] | Event.OPERATOR


def test_words_are_kept_with_the_tick(bridge: ConsoleBridge, peer: Peer, snapshot: Callable[..., Snapshot]) -> None:
    bridge.publish(snapshot(17), 0)
    assert call(peer, act="mark", note="cut in, 2nd try", participant="P07", trial="B-3")[1]["tick"] == 17
    call(peer, act="estop")
    assert bridge.take_acts() == [
        Act(tick=17, act="mark", note="cut in, 2nd try", participant="P07", trial="B-3"),
        Act(tick=17, act="estop"),
    ]
    assert bridge.take_acts() == []


@pytest.mark.parametrize(
    ("args", "words"),
    [
        ({}, "act: '' is not one of"),
        ({"act": "fly"}, "act: 'fly' is not one of autonomous"),
        ({"act": "mark", "note": "x" * 501}, "note: at most 500 printable"),
        ({"act": "mark", "note": "a\nb"}, "note: at most 500 printable"),
        ({"act": "mark", "participant": "x" * 65}, "participant: at most 64"),
        ({"act": "mark", "trial": "\x00"}, "trial: at most 64"),
    ],
)
def test_what_is_no_act_is_refused_and_does_nothing(
    bridge: ConsoleBridge, peer: Peer, args: dict[str, Any], words: str
) -> None:
    result, values = call(peer, **args)
    assert not result
    assert words in values
    assert (events(bridge), bridge.take_acts()) == (Event(0), [])


@pytest.mark.parametrize("role", [Role.NONE, Role.VIEW, Role.PUBLISH])
def test_acts_need_the_role_control(bridge: ConsoleBridge, peer: Peer, role: Role) -> None:
    peer.session.role = role
    result, _ = call(peer, act="estop") if role is not Role.NONE else (False, None)
    assert not result
    assert events(bridge) == Event(0)


def test_a_flood_of_acts_keeps_their_edges_and_refuses_their_words(bridge: ConsoleBridge, peer: Peer) -> None:
    for _ in range(ACTS_MAX):
        bridge.operator.operate({"act": "mark"})
    assert events(bridge) == Event.MARK | Event.OPERATOR
    assert call(peer, act="estop") == (True, {"accepted": True, "tick": 0})
    assert events(bridge) == Event.EMERGENCY_STOP | Event.OPERATOR
    result, words = call(peer, act="mark", note="one too many")
    assert (result, events(bridge)) == (False, Event.MARK | Event.OPERATOR)
    assert "mark is done, but what came with it cannot be recorded" in words
    assert len(bridge.take_acts()) == ACTS_MAX
    assert call(peer, act="mark", note="room again")[0]


@pytest.mark.parametrize("letter", ["a", '"', "\\", "\u20ac", "\U0001f697"])
def test_no_act_is_larger_than_its_place(bridge: ConsoleBridge, letter: str) -> None:
    longest = {"note": letter * NOTE_CHARS, "participant": letter * ID_CHARS, "trial": letter * ID_CHARS}
    bridge.operator.tick = 2**53
    bridge.operator.operate({"act": "anti_lock", **longest})
    assert len(msgspec.json.encode(bridge.take_acts()[0])) <= ACT_BYTES


def summary_of(*acts: dict[str, Any]) -> dict[str, Any]:
    summary = ActsSummary()
    for act in acts:
        summary.add(msgspec.json.encode(act))
    return summary.summary()


def test_summary_names_the_last_participant_and_trial() -> None:
    acts = [{"tick": 1, "act": "mark", "participant": "P1", "trial": "1"}, {"tick": 2, "act": "mark", "trial": "2"}]
    assert summary_of(*acts) == {"participant": "P1", "trial": "2", "acts": acts}
    unnamed = {"tick": 1, "act": "mark"}
    assert summary_of(unnamed) == {"acts": [unnamed]}
    assert summary_of() == {}


def test_a_summary_has_a_bound_and_says_how_many_more_there_are() -> None:
    act = {"tick": 1, "act": "mark", "note": "x" * NOTE_CHARS}
    held = SUMMARY_BYTES // len(msgspec.json.encode(act))
    found = summary_of(*[act] * (held + 7), {"tick": 2, "act": "mark", "participant": "P9"})
    assert (len(found["acts"]), found["more_acts"], found["participant"]) == (held, 8, "P9")
