"""Force feedback under faults: killed, hung, and given nonsense (cases D11 to D13), on the kernel's interface and in
the whole console. What is left on the wheel is told by a kernel that erases a process's effects with its file
(`input_ff_flush`) and plays an effect no longer than it is."""

import math
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.devices.force_feedback.simulated_wheel import HANDS_OFF, RELAXED
from simconsole.devices.haptics.watchdog import POLL_S, STALL_S
from simconsole.values.signals import Event, EventInput, Mode
from simconsole.values.state_vector import LAYOUT
from tests.devices.closed_loop import Loop
from tests.devices.mocked import calls, start
from tests.patience import PATIENCE_S, pause, wait_until
from tests.samples import Measured

LET_GO_S = 0.25
SLOTS = 15  # of the mocked device


def last_force(log: list[dict[str, Any]]) -> tuple[float, float]:
    """Return (when the last constant effect ends by itself at the latest, when its process was last heard), in s."""
    lengths = {call["id"]: call["length_ms"] for call in log if call["what"] == "upload"}
    assert all(0 < length <= 200 for length in lengths.values())
    plays = [call for call in log if call["what"] == "play" and call["value"] == 1]
    ends = max(call["t_ns"] / 1e9 + lengths[call["id"]] / 1e3 for call in plays)
    heard = max(call["t_ns"] for call in log if call["what"] in ("play", "upload")) / 1e9
    return ends, heard


@pytest.mark.fault("D11")
@pytest.mark.parametrize("back_end", ["sdl", "evdev"])
def test_d11_killed_process_leaves_no_force(back_end: str, tmp_path: Path, measured: Measured) -> None:
    """D11: kill -9 at full torque. No effect outlives 200 ms even if the kernel did not erase them at close."""
    log = tmp_path / "calls.jsonl"
    killed = start(log, "kill", back_end)
    killed.communicate(timeout=PATIENCE_S)
    noted = calls(log)
    assert noted[-1]["what"] == "end"
    assert noted[-1]["code"] == -signal.SIGKILL
    assert any(call.get("level") == 32767 for call in noted)
    ends_s, heard_s = last_force(noted)
    assert ends_s - heard_s <= LET_GO_S
    again = tmp_path / "again.jsonl"
    restarted = start(again, "drive", back_end)
    out, err = restarted.communicate(timeout=PATIENCE_S)
    assert restarted.returncode == 0, out + err
    acts = calls(again)
    first = next(index for index, call in enumerate(acts) if call["what"] == "upload")
    assert acts[first]["level"] == 0, "the first thing a new process loads pushes nothing"
    stops = [(call["what"], call.get("value"), call.get("id")) for call in acts[:SLOTS]]
    assert stops == [("play", 0, slot) for slot in range(SLOTS)], "before anything else, all stop"
    seen = f"{len(stops)} stops before anything is loaded; no effect longer than {1e3 * (ends_s - heard_s):.0f} ms"
    measured("D11", f"first acts after a restart, {back_end}", seen, "all stop; 250 ms")


@pytest.mark.fault("D12")
def test_d12_hung_process_lets_go(tmp_path: Path) -> None:
    """D12: SIGSTOP at full torque: nothing starts the effect again, and it ends within 250 ms of the stall."""
    log = tmp_path / "calls.jsonl"
    mock = start(log, "hang")
    try:
        child = stopped_child(mock.pid)
        before = len(calls(log))
        ends_s, heard_s = last_force(calls(log))
        assert ends_s - heard_s <= LET_GO_S
        pause(LET_GO_S)
        assert len(calls(log)) == before, "a stopped process tells the kernel nothing"
        os.kill(child, signal.SIGKILL)
        mock.communicate(timeout=PATIENCE_S)
    finally:
        mock.kill()
        mock.communicate()


@pytest.mark.fault("D12")
@pytest.mark.parametrize("back_end", ["sdl", "evdev"])
def test_d12_watchdog_stops_what_a_hung_process_left(back_end: str, tmp_path: Path, measured: Measured) -> None:
    """SIGSTOP at full torque: another process stops every effect, and no force is left 250 ms after the last start."""
    log = tmp_path / "calls.jsonl"
    mock = start(log, "hang", back_end, "watched")
    try:
        child = stopped_child(mock.pid)
        stops = wait_for_stops(log)
        seen = f"{1e3 * let_go_s(calls(log)):.0f} ms after the last start of an effect"
        measured("D12", f"hung process, {back_end}", seen, "250 ms")
        assert {call["id"] for call in stops} == set(range(SLOTS)), "all there are, whoever loaded them"
        assert let_go_s(calls(log)) <= LET_GO_S
        os.kill(child, signal.SIGKILL)
        mock.communicate(timeout=PATIENCE_S)
    finally:
        mock.kill()
        mock.communicate()


@pytest.mark.fault("D11")
def test_d11_watchdog_stops_what_a_killed_process_left(tmp_path: Path, measured: Measured) -> None:
    log = tmp_path / "calls.jsonl"
    mock = start(log, "kill", "evdev", "watched")
    try:
        mock.communicate(timeout=PATIENCE_S)
        stops = wait_for_stops(log)
        assert {call["id"] for call in stops} == set(range(SLOTS))
        assert let_go_s(calls(log)) <= LET_GO_S
        seen = f"{1e3 * let_go_s(calls(log)):.0f} ms after the last start of an effect"
        measured("D11", "killed process", seen, "250 ms")
    finally:
        mock.kill()
        mock.communicate()


def test_watchdog_of_a_process_that_closes_its_motor_does_nothing(tmp_path: Path) -> None:
    log = tmp_path / "calls.jsonl"
    mock = start(log, "drive", "evdev", "watched")
    out, err = mock.communicate(timeout=PATIENCE_S)
    assert mock.returncode == 0, out + err
    acts = calls(log)[SLOTS:]  # the first are the motor's, which stops everything when it is opened
    closed = max(index for index, call in enumerate(acts) if call["what"] in ("remove", "gain", "autocentre"))
    assert [call["what"] for call in acts[closed + 1 :]] == ["end"]
    starts_s = [call["t_ns"] / 1e9 for call in acts if call["what"] == "play" and call["value"] == 1]
    held_up = max(np.diff(starts_s)) > STALL_S - POLL_S  # by a busy machine: a stall indeed
    assert held_up or {call["id"] for call in acts if call["what"] == "play"} == {0, 1}, "the motor's own two effects"


def wait_for_stops(log: Path) -> list[dict[str, Any]]:
    """Wait until the watchdog has stopped the last slot, which the motor never touches; of a console that has ended.

    While it lived the watchdog may have stopped all before: a loop that a busy machine held up is a stall as well.
    """

    def stops() -> list[dict[str, Any]]:
        plays = [call for call in calls(log)[SLOTS:] if call["what"] == "play"]  # the first are of the motor's opening
        started = max(index for index, call in enumerate(plays) if call["value"] == 1)
        after = plays[started + 1 :]
        return after if any(call["id"] == SLOTS - 1 for call in after) else []

    return wait_until(stops, "the watchdog's stops")


def let_go_s(log: list[dict[str, Any]]) -> float:
    """Return how long after the last start of an effect there was no force: it was stopped, or it had ended."""
    ends_s, _ = last_force(log)
    plays = [call for call in log if call["what"] == "play"]
    started = max(i for i, call in enumerate(plays) if call["value"] == 1)
    stopped = {call["id"]: call["t_ns"] / 1e9 for call in reversed(plays[started:]) if call["value"] == 0}
    return float(min(ends_s, max(stopped[0], stopped[1])) - plays[started]["t_ns"] / 1e9)


def stopped_child(parent: int) -> int:
    """Wait for the program to have stopped itself."""

    def find() -> int | None:
        for stat in Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = stat.read_text().rpartition(")")[2].split()
            except OSError:
                continue
            if fields[1] == str(parent) and fields[0] == "T":
                return int(stat.parent.name)
        return None

    found = wait_until(find, "the program to stop itself")
    assert found is not None
    return found


@pytest.mark.fault("D12")
def test_d12_simulated_wheel_feels_no_force_after_a_stall() -> None:
    """The same in simulated time: the loop stands still, the wheel's own clock goes on."""
    loop = Loop()
    loop.engage()
    loop.wheel.state = loop.wheel.state._replace(rad=0.5)
    for _ in range(20):
        loop.tick(HANDS_OFF)
    assert abs(loop.wheel.state.motor_nm) > 0.3
    for _ in loop.seconds(LET_GO_S):
        loop.wheel.turn(HANDS_OFF)
    assert abs(loop.wheel.state.motor_nm) < 0.01


@pytest.mark.fault("D12")
def test_d12_reported_stall_lets_go_in_the_same_tick() -> None:
    loop = Loop()
    loop.engage()
    for _ in loop.seconds(12.0):
        loop.tick(RELAXED)
    shot = loop.tick(RELAXED, events=EventInput(float(Event.LOOP_STALL)))
    assert (shot.torque.torque_nm, shot.torque.enabled) == (0.0, 0.0)


@pytest.mark.fault("D13")
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e300], ids=str)
@pytest.mark.parametrize("field", ["hand_wheel_torque_nm", "road_wheel_rad"])
def test_d13_nonsense_from_the_vehicle_never_reaches_the_motor(field: str, value: float) -> None:
    """D13: not finite or beyond the maximum, in the row that the torque is made of."""
    loop = Loop()
    loop.engage()
    before = 0.0
    for tick in range(250):
        row = loop.snapshot.vector.copy()
        loop.tick(RELAXED)
        if tick % 3 == 0:
            loop.snapshot.vector[LAYOUT.vehicle.at(field)] = value
            loop.console.force_feedback(row, loop.snapshot.vector, loop.console.settings, loop.console.tick_s)  # type: ignore[misc]
            loop.snapshot.vector[LAYOUT.vehicle.at(field)] = 0.0
        torque = loop.snapshot.torque
        assert math.isfinite(torque.torque_nm)
        assert abs(torque.torque_nm) <= 4.0
        assert torque.enabled == 0.0 or abs(torque.torque_nm - before) <= 150.0 / 250.0 + 1e-9
        assert np.isfinite(loop.snapshot.vector[LAYOUT.torque.start :]).all()
        before = torque.torque_nm


@pytest.mark.fault("D13")
def test_d13_sign_that_flips_every_tick_stays_within_the_slew_limit() -> None:
    loop = Loop()
    loop.engage()
    field = LAYOUT.vehicle.at("road_wheel_rad")
    torques = []
    for tick in range(250):
        row = loop.snapshot.vector.copy()
        loop.tick(RELAXED)
        loop.snapshot.vector[field] = 0.5 if tick % 2 else -0.5
        loop.console.force_feedback(row, loop.snapshot.vector, loop.console.settings, loop.console.tick_s)  # type: ignore[misc]
        torques.append(loop.snapshot.torque.torque_nm)
    assert np.abs(np.diff(torques)).max() <= 150.0 / 250.0 + 1e-9
    assert np.abs(torques).max() <= 4.0


@pytest.mark.parametrize("mode", [Mode.STOPPED, Mode.EMERGENCY_STOP])
def test_stopped_console_holds_nothing(mode: Mode) -> None:
    loop = Loop()
    loop.engage()
    for _ in loop.seconds(4.0):
        loop.tick(RELAXED)
    if mode == Mode.EMERGENCY_STOP:
        loop.tick(RELAXED, events=EventInput(float(Event.EMERGENCY_STOP)))
    else:
        loop.tick(RELAXED, events=EventInput(float(Event.COMMANDER_LOST)))
    for _ in loop.seconds(20.0):
        shot = loop.tick(RELAXED)
        assert shot.torque.torque_nm == 0.0
    assert shot.arbitration.mode == mode
