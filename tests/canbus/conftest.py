"""The codec of the shipped DBC, a snapshot, and a bus of this test's own."""

import itertools
import os
import socket
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.canbus.bus.worker import load_codec
from simconsole.canbus.codec import Codec
from simconsole.canbus.node import CanNode
from simconsole.profiles.can import CanProfile
from simconsole.values.layout import Part
from simconsole.values.signals import Mode, Reason, Validity
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot

_channels = itertools.count()


@pytest.fixture(scope="session")
def codec() -> Codec:
    return load_codec()


@pytest.fixture
def profile() -> CanProfile:
    """A virtual bus that no other test is on."""
    return CanProfile(interface="virtual", channel=f"test-{os.getpid()}-{next(_channels)}", log=())


@pytest.fixture
def snapshot() -> Callable[[int], Snapshot]:
    """A car at 15 m/s, driven autonomously by 60 %, at a tick of 250 Hz; two wheel speeds behind the stages."""
    row = np.zeros(PLATFORM_AT + 2)

    def put(part: Part[Any], **values: float) -> None:
        for name, value in values.items():
            row[part.at(name)] = value

    put(LAYOUT.driver, hand_wheel_rad=-3.0, hand_wheel_radps=1.5, throttle=0.25, brake=0.5, clutch=1.0)
    put(LAYOUT.driver, gear=-1.0, wheel_validity=float(Validity.LIVE), throttle_validity=2.0)
    put(LAYOUT.arbitration, mode=float(Mode.AUTONOMOUS), reason=float(Reason.REMOTE_ASKED))
    put(LAYOUT.arbitration, remote_lateral=0.6, remote_longitudinal=1.0, takeover_stage=1.0, commander=2.0)
    put(LAYOUT.command, road_wheel_rad=0.3, throttle=0.75, brake=0.1, automatic=1.0, gate_active=5.0)
    put(LAYOUT.command, turn_indicators=-1.0, hazard_lights=1.0)
    put(LAYOUT.torque, torque_nm=-1.5, car_nm=-2.0, human_nm=2.25, enabled=1.0, hands_on=1.0)
    put(LAYOUT.vehicle, vx_mps=15.0, yaw_rate_radps=-0.4, ax_mps2=1.25, ay_mps2=-6.0, road_wheel_rad=0.29)
    put(LAYOUT.vehicle, gear=3.0, engine_radps=300.0, engine_running=1.0, clutch=0.4)
    row[PLATFORM_AT:] = (48.0, 50.0)
    return lambda tick: Snapshot(tick, 250, row)


@pytest.fixture
def node(codec: Codec) -> CanNode:
    return CanNode(codec, CanProfile(), 250, wheels=(PLATFORM_AT, PLATFORM_AT + 1, PLATFORM_AT, PLATFORM_AT + 1))


@pytest.fixture
def port() -> int:
    """A UDP port that nobody uses now."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])
