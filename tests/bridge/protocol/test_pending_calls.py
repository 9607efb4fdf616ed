"""Calls and goals that wait for a provider."""

from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge

ADD = "example_interfaces/srv/AddTwoInts"
MS = 1_000_000
PATIENCE_NS = 1000 * MS


@pytest.fixture
def patient(bridge: ConsoleBridge) -> ConsoleBridge:
    bridge.router.calls.held.patience_ns = PATIENCE_NS
    return bridge


def test_without_patience_a_call_fails_at_once(bridge: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer = join(bridge)
    peer.send(op="call_service", service="/add", id=1)
    assert [(message["id"], message["result"]) for message in peer.heard()] == [(1, False)]


def test_a_call_and_a_goal_wait_for_a_provider(patient: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer, provider = join(patient), join(patient)
    peer.send(op="call_service", service="/add", id=1, args={"a": 1})
    peer.send(op="send_action_goal", action="/go", action_type="a/action/Go", id=2, args={})
    peer.send(op="call_service", service="/other", id=3)
    assert (peer.heard(), patient.router.calls.open) == ([], 3)
    provider.send(op="advertise_service", service="/add", type=ADD)
    provider.send(op="advertise_action", action="/go", type="a/action/Go")
    assert [message["op"] for message in provider.heard()] == ["call_service", "send_action_goal"]
    patient.router.calls.expire(PATIENCE_NS)
    assert [(message["id"], message["values"]) for message in peer.heard()] == [(3, "/other: nobody provides it")]
    assert patient.router.calls.open == 2


def test_a_goal_does_not_take_a_service_for_its_action(patient: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer, provider = join(patient), join(patient)
    peer.send(op="send_action_goal", action="/add", action_type="a/action/Go", id=2, args={})
    provider.send(op="advertise_service", service="/add", type=ADD)
    assert (peer.heard(), patient.router.calls.open) == ([], 1)


def test_so_many_wait_as_a_client_may_have_open(patient: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer = join(patient)
    most = patient.profile.limits.calls
    for number in range(most + 1):
        peer.send(op="call_service", service="/add", id=number)
    assert [message["id"] for message in peer.heard()] == [most]


def test_what_a_client_that_leaves_has_asked_for_is_forgotten(patient: ConsoleBridge, join: Callable[..., Any]) -> None:
    peer = join(patient)
    peer.send(op="call_service", service="/add", id=1)
    patient.disconnect(peer.session, 0)
    assert patient.router.calls.open == 0
    patient.router.calls.expire(PATIENCE_NS)
