"""The operator's acts as a service: events, and the words that no row can hold."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.command_decoder import REQUESTS
from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.operator_acts import ACTS_MAX, Act, summarise_acts
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
    assert events(bridge) is REQUESTS[act]


def test_words_are_kept_with_the_tick(bridge: ConsoleBridge, peer: Peer, snapshot: Callable[..., Snapshot]) -> None:
    bridge.publish(snapshot(17), 0)
    assert call(peer, act="mark", note="cut in, 2nd try", participant="P07", trial="B-3")[1]["tick"] == 17
    call(peer, act="estop")
    assert bridge.acts == [
        Act(tick=17, act="mark", note="cut in, 2nd try", participant="P07", trial="B-3"),
        Act(tick=17, act="estop"),
    ]


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
    assert (events(bridge), bridge.acts) == (Event(0), [])


@pytest.mark.parametrize("role", [Role.NONE, Role.VIEW, Role.PUBLISH])
def test_acts_need_the_role_control(bridge: ConsoleBridge, peer: Peer, role: Role) -> None:
    peer.session.role = role
    result, _ = call(peer, act="estop") if role is not Role.NONE else (False, None)
    assert not result
    assert events(bridge) == Event(0)


def test_a_flood_of_notes_is_not_kept_without_bound(bridge: ConsoleBridge, peer: Peer) -> None:
    for _ in range(ACTS_MAX + 5):
        bridge.operator.operate({"act": "mark"})
    assert len(bridge.acts) == ACTS_MAX


def test_summary_names_the_last_participant_and_trial() -> None:
    acts = [{"tick": 1, "act": "mark", "participant": "P1", "trial": "1"}, {"tick": 2, "act": "mark", "trial": "2"}]
    assert summarise_acts(acts) == {"participant": "P1", "trial": "2", "acts": acts}
    unnamed = [{"tick": 1, "act": "mark"}]
    assert summarise_acts(unnamed) == {"acts": unnamed}
    assert summarise_acts([]) == {}
