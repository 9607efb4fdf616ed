import json
import queue
import threading
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.messages import Registry
from simconsole.bridge.protocol.client_session import ClientSession
from simconsole.bridge.protocol.server_protocol import Outcome
from simconsole.bridge.transport.server import serve
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.signals import Arbitration, DeviceSample, EventInput, RemoteCommand, VehicleCommand, VehicleState
from simconsole.values.state_vector import LAYOUT, PLATFORM_AT, Snapshot
from tests.patience import PATIENCE_S

STAGES: dict[type[Any], int] = {
    DeviceSample: LAYOUT.sample.start,
    RemoteCommand: LAYOUT.ros.start,
    EventInput: LAYOUT.events.start,
    VehicleCommand: LAYOUT.command.start,
    Arbitration: LAYOUT.arbitration.start,
    VehicleState: LAYOUT.vehicle.start,
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
        self.session: ClientSession = bridge.router.connect(name)

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


class Served:
    """A bridge server on a thread of its own, as its process would run it."""

    def __init__(self, profile: BridgeProfile, registry: Registry | None = None) -> None:
        self.commands: queue.SimpleQueue[tuple[RemoteCommand, int | None]] = queue.SimpleQueue()
        self.events: queue.SimpleQueue[int] = queue.SimpleQueue()
        self.standings: queue.SimpleQueue[str] = queue.SimpleQueue()
        self.snapshots: queue.SimpleQueue[Snapshot] = queue.SimpleQueue()
        self._port: queue.SimpleQueue[int] = queue.SimpleQueue()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(profile, registry))
        self._thread.start()
        self.port = self._port.get(timeout=PATIENCE_S)
        self.url = f"ws://127.0.0.1:{self.port}"

    def _run(self, profile: BridgeProfile, registry: Registry | None) -> None:
        serve(
            profile,
            self._newest,
            lambda command, receipt_ns: self.commands.put((command, receipt_ns)),
            self.events.put,
            self._stop.is_set,
            on_ready=self._port.put,
            on_link_state=self.standings.put,
            registry=registry,
        )

    def _newest(self) -> Snapshot | None:
        try:
            return self.snapshots.get_nowait()
        except queue.Empty:
            return None

    def command(self) -> RemoteCommand:
        """The next change of the command."""
        return self.commands.get(timeout=PATIENCE_S)[0]

    def stop(self) -> None:
        self._stop.set()
        self._thread.join(timeout=PATIENCE_S)
        assert not self._thread.is_alive()


@pytest.fixture(params=["websockets", "picows"])
def transport(request: pytest.FixtureRequest) -> str:
    """Each library that can carry clients' connections: what a client sees must not differ."""
    name: str = request.param
    return name


@pytest.fixture
def serving(transport: str) -> Iterator[Callable[..., Served]]:
    """Start a server with a profile on a free port, with each library; it is stopped at the end."""
    started: list[Served] = []

    def start(**profile: Any) -> Served:
        started.append(Served(BridgeProfile(**{"port": 0, "transport": transport, **profile})))
        return started[-1]

    yield start
    for server in started:
        server.stop()
