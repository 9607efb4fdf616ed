import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.console import ConsoleBridge
from simconsole.bridge.protocol import Outcome
from simconsole.bridge.session import Session
from simconsole.profiles.bridge import BridgeProfile
from simconsole.rows import ARBITRATION_AT, PLATFORM_AT, REMOTE_AT, SAMPLE_AT, VEHICLE_AT, Snapshot
from simconsole.signals import Arbitration, DeviceSample, RemoteCommand, VehicleState

STAGES: dict[type[Any], int] = {
    DeviceSample: SAMPLE_AT,
    RemoteCommand: REMOTE_AT,
    Arbitration: ARBITRATION_AT,
    VehicleState: VEHICLE_AT,
}


def make_snapshot(tick: int, tick_hz: int = 250, **fields: float) -> Snapshot:
    """A snapshot of zeros but for the named fields of whichever stage has them first."""
    row = np.zeros(PLATFORM_AT)
    for name, value in fields.items():
        stage = next(stage for stage in reversed(STAGES) if name in stage._fields)
        row[STAGES[stage] + stage._fields.index(name)] = value
    return Snapshot(tick, tick_hz, row)


class Peer:
    """A client of a console bridge, without a socket."""

    def __init__(self, bridge: ConsoleBridge, name: str = "peer") -> None:
        self.bridge = bridge
        self.now_ns = 0
        self.session: Session = bridge.router.connect(name)

    def send(self, text: bytes | str | None = None, **operation: Any) -> Outcome:
        if text is None:
            text = json.dumps(operation)
        data = text.encode() if isinstance(text, str) else text
        return self.bridge.receive(self.session, data, self.now_ns)

    def publish(self, topic: str, msg: Any, **more: Any) -> Outcome:
        return self.send(op="publish", topic=topic, msg=msg, **more)

    def heard(self, now_ns: int | None = None) -> list[dict[str, Any]]:
        """Everything that may be sent to the client now, decoded strictly."""
        texts = []
        while (text := self.session.next_text(self.now_ns if now_ns is None else now_ns)) is not None:
            texts.append(json.loads(text, parse_constant=pytest.fail))
        return texts

    def statuses(self) -> list[str]:
        return [message["msg"] for message in self.heard() if message["op"] == "status"]


@pytest.fixture
def snapshot() -> Callable[..., Snapshot]:
    return make_snapshot


@pytest.fixture
def bridge() -> ConsoleBridge:
    return ConsoleBridge(BridgeProfile(port=0))


@pytest.fixture
def peer(bridge: ConsoleBridge) -> Peer:
    return Peer(bridge)


@pytest.fixture
def join() -> Callable[[ConsoleBridge], Peer]:
    return Peer


@pytest.fixture
def control() -> Callable[..., dict[str, Any]]:
    """An autoware_control_msgs/Control as plain values."""

    def make(road_wheel_rad: float = 0.1, accel_mps2: float = 1.0, stamp_ns: int = 0) -> dict[str, Any]:
        return {
            "stamp": {"sec": stamp_ns // 10**9, "nanosec": stamp_ns % 10**9},
            "lateral": {"steering_tire_angle": road_wheel_rad},
            "longitudinal": {"acceleration": accel_mps2},
        }

    return make
