"""A drive in lockstep and its controller's faults: each ends in a defined state that the log tells."""

import json
import signal
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.reading import LogTable
from simconsole.session.lifecycle import DriveResult, drive
from simconsole.session.resolution import load_session, override, resolve
from simconsole.values.signals import Event, Mode, Reason
from tests.drives.console import Running
from tests.drives.controllers import Controller, command
from tests.patience import PATIENCE_S, wait_until
from tests.ports import free_port

TICK_HZ = 250
PERIOD_TICKS = 5
SESSION = """\
schema: 1
title: In lockstep
scenario: {vehicle: hatchback, duration_s: 9}
features: {control: {person_required: false}}
outputs: {bridge: {port: 0}, hud: null, scene: null, report: false}
devices: {driver: none}
mode: {pacing: lockstep, tick_hz: 250, answer_timeout_s: 0.5}
"""
ASK = json.dumps({"op": "publish", "topic": "/console/request", "msg": {"data": "autonomous"}})
ASKED_AT = 30
"""The odometry, one each 20 ms, at which the controller asks for the car."""
FAULT_AT = 200
Answer = Callable[[int, dict[str, int]], list[str] | None]


class Driven(NamedTuple):
    """A finished drive and its controller."""

    result: DriveResult
    table: LogTable
    controller: Controller


@pytest.fixture
def drive_with(tmp_path: Path) -> Callable[..., Driven]:
    """Drive with a controller that answers as told."""
    session_file = tmp_path / "session.yaml"
    session_file.write_text(SESSION)

    def run(answer: Answer, name: str = "bundle", **scenario: Any) -> Driven:
        port = free_port()
        session = override(load_session(str(session_file)), outputs={"bridge": {"port": port}}, scenario=scenario)
        controller = Controller(port, answer)
        controller.start()
        result = drive(resolve(session), tmp_path / name)
        controller.join(PATIENCE_S)
        assert not controller.is_alive()
        assert controller.failure is None
        return Driven(result, open_bundle(tmp_path / name).log.table(), controller)

    return run


def good(count: int, stamp: dict[str, int]) -> list[str]:
    """Asks for the car once, drives gently and in a slight bend."""
    asks = [ASK] if count == ASKED_AT else []
    return [*asks, json.dumps(command(stamp, 1.2, 0.02 * np.sin(count / 50.0)))]


def with_fault(*texts: str) -> Answer:
    """As `good`, but `texts` come before the answer number FAULT_AT."""

    def answer(count: int, stamp: dict[str, int]) -> list[str]:
        return [*(texts if count == FAULT_AT else ()), *good(count, stamp)]

    return answer


def modes(table: LogTable) -> Iterator[tuple[int, Mode, Reason]]:
    """Each change of mode: (tick, mode, reason)."""
    before = None
    for tick, mode, reason in zip(
        table.ticks, table.column("arbitration.mode"), table.column("arbitration.reason"), strict=True
    ):
        if mode != before:
            yield int(tick), Mode(int(mode)), Reason(int(reason))
        before = mode


def events(table: LogTable, event: Event) -> list[int]:
    """The ticks at which `event` was recorded."""
    return [int(tick) for tick in table.ticks[(table.column("events.events").astype(int) & int(event)) != 0]]


def test_two_drives_with_the_same_controller_are_equal_to_the_bit(drive_with: Callable[..., Driven]) -> None:
    first, second = drive_with(good, "first"), drive_with(good, "second")
    assert first.result.digest == second.result.digest
    assert [mode for _, mode, _ in modes(first.table)][-1] is Mode.AUTONOMOUS
    assert first.table.column("vehicle.vx_mps")[-1] > 5.0
    assert first.result.summary["unanswered"] == 0
    assert first.controller.odometry == 9 * TICK_HZ // PERIOD_TICKS
    assert replay_bundle(first.result.folder).equal


@pytest.mark.parametrize(
    "frame",
    [
        '{"op": "publish", "topic": "/control/command/control_cmd", "msg": {',
        "\x00\x01 no JSON at all",
        '{"op": "explode"}',
        "[" * 5000,
        json.dumps({"op": "publish", "topic": 7, "msg": {}}),
    ],
)
def test_a_malformed_frame_is_answered_and_the_drive_goes_on_as_without_it(
    drive_with: Callable[..., Driven], frame: str
) -> None:
    driven = drive_with(with_fault(frame), duration_s=6)
    assert any(status["level"] == "error" for status in driven.controller.statuses)
    assert [mode for _, mode, _ in modes(driven.table)][-1] is Mode.AUTONOMOUS
    assert driven.result.summary["unanswered"] == 0
    untouched = drive_with(good, "untouched", duration_s=6)
    columns = [name for name in driven.table.columns if name not in ("ros.refused", "ros_link.refused_seen")]
    unlike = [name for name in columns if not np.array_equal(driven.table.column(name), untouched.table.column(name))]
    assert set(unlike) <= {"ros_link.invalid_run", "ros_link.fresh_ticks", "ros_link.state"}


@pytest.mark.parametrize(
    "spoilt",
    [
        json.dumps(command({"sec": 0, "nanosec": 0}, float("nan"))),
        json.dumps(command({"sec": 0, "nanosec": 0}, None)),
        json.dumps(command({"sec": 0, "nanosec": 0}, 1.0, float("nan"))),
        json.dumps(command({"sec": 0, "nanosec": 0}, 1.0)).replace('"acceleration": 1.0', '"acceleration": 1e999'),
        json.dumps(command({"sec": 0, "nanosec": 0}, 1.0, 9.0)),
    ],
    ids=["NaN acceleration", "null acceleration", "NaN angle", "1e999", "beyond every wheel"],
)
def test_a_command_that_is_no_number_is_refused_whole_and_counted(
    drive_with: Callable[..., Driven], spoilt: str
) -> None:
    driven = drive_with(with_fault(spoilt), duration_s=6)
    refused = driven.table.column("ros.refused")
    assert refused[-1] == 1.0
    at = refused.tolist().index(1.0)
    assert driven.table.ticks[at] == (FAULT_AT - 1) * PERIOD_TICKS + PERIOD_TICKS + 1
    assert any(status["level"] == "error" for status in driven.controller.statuses)
    assert np.isfinite(driven.table.vectors).all()
    assert driven.table.column("ros.accel_mps2").max() <= 1.2
    assert [mode for _, mode, _ in modes(driven.table)][-1] is Mode.AUTONOMOUS, "one bad command is no reason to stop"


def test_five_bad_commands_and_no_good_one_end_in_a_safe_stop(drive_with: Callable[..., Driven]) -> None:
    spoilt = json.dumps(command({"sec": 0, "nanosec": 0}, None))
    driven = drive_with(lambda count, stamp: [spoilt] * 5 if count >= FAULT_AT else good(count, stamp))
    changes = list(modes(driven.table))
    assert [change[1] for change in changes][-3:] == [Mode.AUTONOMOUS, Mode.MINIMAL_RISK, Mode.STOPPED]
    assert changes[-2][0] == FAULT_AT * PERIOD_TICKS + 1, "at once, not when the last good command has grown stale"
    assert changes[-2][2] is Reason.COMMAND_INVALID
    assert driven.table.column("ros.refused")[changes[-2][0] - 1] == 5.0


def test_a_vanished_controller_ends_in_a_recorded_safe_stop(drive_with: Callable[..., Driven]) -> None:
    driven = drive_with(lambda count, stamp: None if count == FAULT_AT else good(count, stamp))
    lost = events(driven.table, Event.COMMANDER_LOST)
    assert len(lost) == 1
    changes = list(modes(driven.table))
    assert [change[1] for change in changes][-3:] == [Mode.AUTONOMOUS, Mode.MINIMAL_RISK, Mode.STOPPED]
    tick, _, reason = changes[-2]
    assert tick == lost[0], "in the very tick in which the loss is known"
    assert reason is Reason.COMMANDER_LOST
    assert tick <= FAULT_AT * PERIOD_TICKS + 2 * PERIOD_TICKS
    assert abs(driven.table.column("vehicle.vx_mps")[-1]) < 0.01
    assert replay_bundle(driven.result.folder).equal


def test_a_silent_controller_is_recorded_as_no_answer_and_ends_in_a_safe_stop(
    drive_with: Callable[..., Driven],
) -> None:
    driven = drive_with(lambda count, stamp: [] if count >= FAULT_AT else good(count, stamp))
    silent = events(driven.table, Event.NO_ANSWER)
    assert silent == [FAULT_AT * PERIOD_TICKS + 1], "once, in the tick after the period that nobody answered"
    assert driven.result.summary["unanswered"] == 1, "afterwards the drive does not wait again"
    assert not events(driven.table, Event.COMMANDER_LOST)
    changes = list(modes(driven.table))
    assert [change[1] for change in changes][-3:] == [Mode.AUTONOMOUS, Mode.MINIMAL_RISK, Mode.STOPPED]
    assert changes[-2][2] is Reason.COMMAND_STALE
    assert changes[-2][0] - silent[0] <= 0.21 * TICK_HZ
    assert replay_bundle(driven.result.folder).equal


def test_a_controller_that_speaks_again_is_waited_for_again_but_not_given_the_car(
    drive_with: Callable[..., Driven],
) -> None:
    def pausing(count: int, stamp: dict[str, int]) -> list[str]:
        return [] if FAULT_AT <= count < FAULT_AT + 3 else good(count, stamp)

    driven = drive_with(pausing, duration_s=40)
    assert driven.result.summary["exchanges"] > FAULT_AT + 100
    assert [change[1] for change in modes(driven.table)][-2:] == [Mode.MINIMAL_RISK, Mode.STOPPED]
    assert driven.table.column("ros.age_ticks")[-1] < PERIOD_TICKS, "it is heard"


def test_ctrl_c_while_waiting_for_a_controller_leaves_nothing(tmp_path: Path) -> None:
    session = tmp_path / "session.yaml"
    port = free_port()
    session.write_text(SESSION.replace("port: 0", f"port: {port}"))
    with Running(tmp_path / "run", "drive", session, "--out", tmp_path / "out" / "bundle") as running:
        connected = threading.Event()
        bystander = Controller(port, lambda count, stamp: [])
        bystander._follow = lambda link: connected.set()  # type: ignore[method-assign]  # connects, asks for nothing
        bystander.start()
        wait_until(connected.is_set, "the bridge")
        running.process.send_signal(signal.SIGINT)
        done = running.end()
    bystander.join()
    assert done.returncode == 130
    assert done.stderr == ""
    assert not (tmp_path / "out").exists()


def test_nobody_comes_is_one_line(tmp_path: Path) -> None:
    session = tmp_path / "session.yaml"
    session.write_text(SESSION.replace("answer_timeout_s: 0.5", "wait_for_controller_s: 0.2"))
    with Running(tmp_path / "run", "drive", session, "--out", tmp_path / "bundle") as running:
        done = running.end()
    assert done.returncode == 2
    assert "no controller subscribed to odometry at ws://127.0.0.1:" in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not (tmp_path / "bundle").exists()
