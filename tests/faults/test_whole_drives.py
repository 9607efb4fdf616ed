"""Whole drives over a real WebSocket, each with a fault: they end as docs/faults.md says, and tell why.

`pytest --long tests/faults/test_whole_drives.py` drives them all; the autopilot is a process of its own that speaks
rosbridge.
"""

import json
import socket
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from websockets.sync.client import ClientConnection

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import recorded_drive
from simconsole.evaluation.report.exports import REPORT, write_report
from simconsole.evaluation.report.page import page
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import state_at
from simconsole.recording.reading import LogTable
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.tick.advance import advance_vector
from simconsole.values.labels import reason_label
from simconsole.values.signals import Event, Mode, Reason
from simconsole.values.state_vector import INPUT_WIDTH, Snapshot
from tests.bits import difference
from tests.bridge.networks import go_deaf
from tests.drives.controllers import Controller, command
from tests.faults.course import CAR_M, HZ, LANE_M, circuit
from tests.patience import PATIENCE_S
from tests.ports import free_port
from tests.samples import Sample

IN_LANE_M = 0.5 * (LANE_M - CAR_M)
SESSION = """schema: 1
environment: {world: urban}
scenario:
  vehicle: hatchback
  duration_s: DURATION
  faults: [{kind: KIND, at_distance_m: 60}]
features: {autopilot: urban}
outputs: {bridge: {port: 0}, hud: null, scene: null, report: false}
devices: {driver: "script:person.yaml"}
mode: {pacing: lockstep, answer_timeout_s: 60}
"""
"""The faults are the scenario's alone: an autopilot that a busy machine holds up is waited for, and no fault."""
PERSON = """points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 1.0, press: [autonomous]}
"""


REST_TICKS = 2 * HZ
LONG_S, SHORT_S = 45, 30
"""A request to take over that nobody answers stands for ten seconds; a safe stop begins at once."""


class Ending(NamedTuple):
    """What a fault leads to: the mode it ends autonomy with, why, and within what time; None: it does not."""

    reason: Reason | None
    within_ms: float = 0.0
    mode: Mode = Mode.MINIMAL_RISK

    @property
    def duration_s(self) -> int:
        """How long a drive is to have come to this end, or to have gone on for long."""
        return SHORT_S if self.mode is Mode.MINIMAL_RISK else LONG_S


STALE, INVALID = Ending(Reason.COMMAND_STALE, 210.0), Ending(Reason.COMMAND_INVALID, 210.0)
LOST = Ending(Reason.DEVICE_LOST, 104.0, Mode.TAKEOVER_REQUESTED)
LEFT = Ending(Reason.COMMANDER_LOST, 210.0)
ENDINGS = {
    "silent": STALE,
    "disconnected": LEFT,
    "refused": INVALID,
    "late_commands, by_ms: 300": STALE,
    "late_commands, by_ms: 150": Ending(None),
    "not_finite": INVALID,
    "astray, road_wheel_deg: 34": INVALID,
    "unplug, device: wheel": LOST,
    "freeze, device: pedals": LOST,
    "invalid, axis: wheel": LOST,
    "stall, stall_ms: 500": Ending(Reason.LOOP_STALL, 250.0),
    "stall, stall_ms: 50": Ending(None),
    "raises, part: devices": LOST,
    "raises, part: ros": LEFT,
    "raises, part: outputs": Ending(None),
}
ONE_OF_EACH = (
    *("silent", "disconnected", "refused", "late_commands, by_ms: 150", "unplug, device: wheel"),
    *("stall, stall_ms: 500", "raises, part: ros", "raises, part: outputs"),
)
"""What `make test` drives: for each way in which the console answers, one kind; test_course.py drives all of them."""


class Rested:
    """Ends a drive that has been stopped for a while."""

    def __init__(self) -> None:
        self._ticks = 0

    def __call__(self, snapshot: Snapshot) -> bool:
        self._ticks = self._ticks + 1 if snapshot.arbitration.mode == Mode.STOPPED else 0
        return self._ticks >= REST_TICKS


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Give each drive a test of its own."""
    if "kind" in metafunc.fixturenames:
        metafunc.parametrize("kind", ENDINGS if metafunc.config.option.long else ONE_OF_EACH)


def reported(bundle: Path, drawn: bool) -> tuple[str, str]:
    """What the report says, in figures and as a page; with the drawings of the page, or its words alone."""
    if drawn:
        return str(write_report(bundle)), (bundle / REPORT).read_text("utf-8")
    found = metrics(recorded_drive(open_bundle(bundle).log), None)
    return str(found), page("A drive", found, (), {}, {})


def test_a_whole_drive_with_a_fault_ends_as_promised_and_its_report_says_why(
    kind: str, tmp_path: Path, sample: Sample
) -> None:
    ending = ENDINGS[kind]
    session = SESSION.replace("KIND", kind).replace("DURATION", str(ending.duration_s))
    (tmp_path / "session.yaml").write_text(session)
    (tmp_path / "person.yaml").write_text(PERSON)
    result = drive(resolve(load_session(str(tmp_path / "session.yaml"))), tmp_path / "bundle", Rested())
    table = open_bundle(tmp_path / "bundle").log.table()
    modes = table.column("arbitration.mode")
    assert table.column("events.faults").any(), f"ended before its fault: {result.summary}"
    fault = int(np.flatnonzero(table.column("events.faults"))[0])
    assert modes[fault - 1] == Mode.AUTONOMOUS
    x, y, yaw = (float(table.column(f"vehicle.{name}")[-1]) for name in ("x_m", "y_m", "yaw_rad"))
    place = circuit().course.project(x, y, None, yaw)
    print(f"{kind}: ends {place.lateral_m:.2f} m beside the lane's centre; {len(modes)} ticks")
    assert abs(place.lateral_m) <= IN_LANE_M
    if ending.reason is None:
        assert set(modes[fault:]) == {Mode.AUTONOMOUS}
        return
    left = int(np.flatnonzero(modes[fault:] != Mode.AUTONOMOUS)[0])
    assert left * 1000.0 / HZ <= ending.within_ms
    assert modes[fault + left] == ending.mode
    assert set(modes[-REST_TICKS:]) == {Mode.STOPPED}
    assert abs(table.column("vehicle.vx_mps")[-1]) < 0.1
    assert all(reason_label(ending.reason) in told for told in reported(tmp_path / "bundle", sample.long))


def test_a_row_of_a_whole_drive_is_a_state_to_drive_on_from(tmp_path: Path) -> None:
    (tmp_path / "session.yaml").write_text(SESSION.replace("KIND", "silent").replace("DURATION", "10"))
    (tmp_path / "person.yaml").write_text(PERSON)
    drive(resolve(load_session(str(tmp_path / "session.yaml"))), tmp_path / "bundle")
    table = open_bundle(tmp_path / "bundle").log.table()
    console, state = state_at(tmp_path / "bundle", 1000)
    row = state.vector
    for recorded in table.vectors[1000:2000]:
        row = advance_vector(row, recorded[:INPUT_WIDTH], console)
        assert not difference(row, recorded)


HALF_OPEN = """schema: 1
scenario: {vehicle: hatchback, duration_s: 12}
features: {control: {person_required: false}}
outputs: {bridge: {port: 0}, hud: null, scene: null, report: false}
devices: {driver: none}
mode: {pacing: lockstep, tick_hz: 250, answer_timeout_s: 0.5}
"""
ASK = json.dumps({"op": "publish", "topic": "/console/request", "msg": {"data": "autonomous"}})


class HalfOpen(Controller):
    """Drives off, asks for the car, and after a while hears and says nothing more; its socket stays open."""

    sock: socket.socket

    def __init__(self, port: int, driven: int) -> None:
        super().__init__(port, self.answers)
        self._driven = driven

    def _connected(self) -> ClientConnection:
        link = super()._connected()
        self.sock = link.socket
        return link

    def answers(self, count: int, stamp: dict[str, int]) -> list[str] | None:
        if count == self._driven:
            go_deaf(self.sock)
        if count >= self._driven:
            return []
        asks = [ASK] if count % 50 == 0 else []
        return [*asks, json.dumps(command(stamp, 1.2, 0.0))]


def newest(table: LogTable) -> int:
    """The last tick in which a new command was taken."""
    return int(np.flatnonzero(np.diff(table.column("ros.sequence")))[-1]) + 1


@pytest.mark.fault("N04")
def test_n04_a_real_half_open_connection_in_a_drive_is_stale_in_time(
    tmp_path: Path, record_property: Callable[[str, object], None]
) -> None:
    (tmp_path / "session.yaml").write_text(HALF_OPEN)
    port = free_port()
    controller = HalfOpen(port, 250)
    controller.start()
    session = override(load_session(str(tmp_path / "session.yaml")), outputs={"bridge": {"port": port}})
    drive(resolve(session), tmp_path / "bundle")
    controller.sock.shutdown(socket.SHUT_RDWR)  # deaf, it would never hear that the drive has ended
    controller.join(PATIENCE_S)
    table = open_bundle(tmp_path / "bundle").log.table()
    modes, last = table.column("arbitration.mode"), newest(table)
    left = int(np.flatnonzero(modes[last:] != Mode.AUTONOMOUS)[0])
    record_property("N04, half-open connection", f"{left * 1000 / HZ:.0f} ms from the last command to the safe stop")
    assert modes[last] == Mode.AUTONOMOUS
    assert modes[last + left] == Mode.MINIMAL_RISK
    assert table.column("arbitration.reason")[last + left] == Reason.COMMAND_STALE
    assert left * 1000 / HZ <= 210
    assert not (table.column("events.events").astype(int)[: last + left] & int(Event.COMMANDER_LOST)).any()
    assert modes[-1] == Mode.STOPPED
