"""The console's side of the watchdog: beats, and that it comes and goes with its console."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from simconsole.devices.force_feedback.motor import NoHaptics, SimulatedWheelPort
from simconsole.devices.force_feedback.simulated_wheel import SimulatedWheel
from simconsole.devices.haptics import watchdog_client as parent
from simconsole.devices.haptics.watchdog import BEATS, FORCE
from simconsole.devices.haptics.watchdog_client import Watchdog, WatchdogPort, open_watchdog, with_watchdog
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.errors import DeviceError
from tests.patience import wait_until

NOBODY = (0xFFFF, 0xFFFF)


class Words:
    """A watchdog that only counts."""

    def __init__(self) -> None:
        self.beats: list[bool] = []

    def beat(self, force: bool) -> None:
        self.beats.append(force)


def port(words: Words) -> WatchdogPort:
    force = ForceFeedback(max_torque_nm=4.0)
    wheel = SimulatedWheel(force, 1080.0, tick_hz=250)
    return WatchdogPort(SimulatedWheelPort(wheel), words)  # type: ignore[arg-type]  # as far as a port needs it


def test_every_start_is_a_beat_and_stop_and_close_say_that_nothing_is_left() -> None:
    words = Words()
    motor = port(words)
    motor.write(0.5)
    motor.start()
    motor.start()
    motor.stop()
    motor.close()
    assert words.beats == [True, True, False, False]


def test_motor_without_force_is_not_watched() -> None:
    none = NoHaptics("none")
    assert with_watchdog(none, Words()) is none  # type: ignore[arg-type]  # as far as a port needs it
    assert with_watchdog(none, None) is none


def test_process_comes_and_goes_with_its_console() -> None:
    before = set(Path("/dev/shm").glob("simconsole-beat-*"))
    watchdog = Watchdog(NOBODY)
    process_id = watchdog.process_id
    assert process_id is not None
    assert os.getpgid(process_id) == process_id, "a stop of the console's group does not stop it"
    watchdog.beat(force=True)
    assert (watchdog._words[FORCE], watchdog._words[BEATS]) == (1, 1)
    watchdog.close()
    watchdog.close()
    assert watchdog.process_id is None
    with pytest.raises(ProcessLookupError):
        os.kill(process_id, 0)
    assert set(Path("/dev/shm").glob("simconsole-beat-*")) <= before


def test_killed_console_leaves_neither_process_nor_memory() -> None:
    code = (
        "import os, signal, sys\nfrom simconsole.devices.haptics.watchdog_client import Watchdog\n"
        "w = Watchdog((65535, 65535))\nw.beat(True)\nprint(w.process_id, w._path, flush=True)\nsys.stdin.read(1)\n"
        "os.kill(os.getpid(), signal.SIGKILL)"
    )
    console = subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert console.stdout is not None
    process_id, path = console.stdout.readline().split()
    wait_until(lambda: not Path(path).exists(), "the watchdog to unlink its memory, once it has it")
    console.communicate("x")
    wait_until(lambda: not Path(f"/proc/{process_id}").exists(), "the end of the watchdog")


def test_no_watchdog_is_said_and_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(self: Watchdog, identity: tuple[int, int]) -> None:
        raise DeviceError("wheel: watchdog: no more processes")

    monkeypatch.setattr(parent.Watchdog, "__init__", refuse)
    lines: list[str] = []
    assert open_watchdog(NOBODY, lines.append) is None
    assert "no more processes; forces end by themselves after 0.2 s" in lines[0]
