"""Force through SDL: against the kernel's own interface, mocked; and joysticks that have none."""

import ctypes
import json
import math
from pathlib import Path
from typing import Any

import pytest

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.haptics.sdl_haptics import _Condition, _Constant, _Effect, open_haptics
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.signals import Button, DeviceSample
from tests.devices.calibration_run import CalibrationRun
from tests.devices.mocked import calls, start
from tests.patience import PATIENCE_S

FF_CONSTANT, FF_DAMPER = 0x52, 0x55
STEERING = 0x4000
FORCE = ForceFeedback(max_torque_nm=4.0)


@pytest.fixture(scope="module", params=["sdl", "evdev"])
def driven(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> list[dict[str, Any]]:
    """The calls of one drive: levels 0, 0.5, 1, -1, -0.25, 9, -9, 0, then closed twice."""
    log = tmp_path_factory.mktemp("mock") / "calls.jsonl"
    done = start(log, "drive", request.param)
    out, err = done.communicate(timeout=PATIENCE_S)
    assert done.returncode == 0, out + err
    assert "vendor_id=1103, product_id=46686, name='Thrustmaster TRS Racing wheel'" in out
    assert "constant=True, gain=True, autocentre=True, damper=True" in out
    return calls(log)


def uploads(driven: list[dict[str, Any]], kind: int) -> list[dict[str, Any]]:
    return [call for call in driven if call["what"] == "upload" and call["type"] == kind]


def test_kernel_gets_one_constant_effect_its_levels_and_its_end(driven: list[dict[str, Any]]) -> None:
    constant = uploads(driven, FF_CONSTANT)
    assert [call["new"] for call in constant] == [True] + [False] * (len(constant) - 1)
    assert {call["direction"] for call in constant} == {STEERING}
    steps = [0, 64, 127, -127, -32, 127, -127, 0]
    assert [call["level"] for call in constant] == [round(step / 127 * 32767) for step in steps]
    (slot,) = {call["id"] for call in constant}
    assert [call for call in driven if call["what"] == "remove" and call["id"] == slot]


def test_every_effect_is_finite_and_started_again_while_ticks_come(driven: list[dict[str, Any]]) -> None:
    assert {call["length_ms"] for call in driven if call["what"] == "upload"} == {200}
    (slot,) = {call["id"] for call in uploads(driven, FF_CONSTANT)}
    starts = [call["t_ns"] for call in driven if call["what"] == "play" and call["id"] == slot and call["value"] == 1]
    assert len(starts) >= 3
    assert len(starts) <= (starts[-1] - starts[0]) / 50e6 + 2, "not at every tick"


def test_gain_and_autocentre_are_set_first_and_left_as_the_profile_says(driven: list[dict[str, Any]]) -> None:
    """Before them every effect is stopped that may have been left running."""
    first = next(index for index, call in enumerate(driven) if call["what"] != "play")
    assert first > 1
    assert {call["value"] for call in driven[:first]} == {0}
    assert [call["what"] for call in driven[first : first + 3]] == ["gain", "autocentre", "upload"]
    assert [call["value"] for call in driven[first : first + 2]] == [65535, 0]
    end = [call for call in driven if call["what"] in ("gain", "autocentre")][-2:]
    assert [call["value"] for call in end] == [65535, round(0.2 * 65535)]


def test_device_damper_runs_beside_it(driven: list[dict[str, Any]]) -> None:
    (damper,) = uploads(driven, FF_DAMPER)
    assert damper["new"]
    assert [call for call in driven if call["what"] == "play" and call["id"] == damper["id"] and call["value"] == 1]


def test_after_closing_nothing_plays(driven: list[dict[str, Any]]) -> None:
    playing: dict[int, int] = {}
    for call in driven:
        if call["what"] == "play":
            playing[call["id"]] = call["value"]
        if call["what"] == "remove":
            playing.pop(call["id"], None)
    assert not any(playing.values())
    assert driven[-1] == {**driven[-1], "what": "end", "code": 0}


def test_recorded_motion_of_a_t500_arrives_as_a_person(tmp_path: Path, t500: CockpitProfile) -> None:
    """The kernel's events of a wheel, a pedal and a paddle, through SDL's own evdev driver, calibrated."""
    done = start(tmp_path / "calls.jsonl", "motion", motion=Path(__file__).with_name("t500_motion.txt"))
    out, err = done.communicate(timeout=PATIENCE_S)
    assert done.returncode == 0, out + err
    calibration = CalibrationRun(cockpit_settings(t500, 250))
    drivers = [
        calibration.calibrate(DeviceSample(**json.loads(line))) for line in out.splitlines() if line.startswith("{")
    ]
    assert len(drivers) >= 40
    first, last = drivers[1], drivers[-1]
    assert (first.throttle, first.brake, first.clutch) == (0.0, 0.0, 0.0), "at rest before the first report"
    angles = [driver.hand_wheel_rad for driver in drivers]
    assert max(angles) == pytest.approx(math.radians(540.0), rel=0.01), "the lock on the left"
    assert min(angles) > -0.01
    assert max(driver.throttle for driver in drivers) == 1.0
    assert {driver.brake for driver in drivers} == {0.0}
    assert [driver.edges for driver in drivers].count(float(Button.SHIFT_DOWN)) == 1
    assert (last.hand_wheel_rad, last.throttle) == (pytest.approx(0.0, abs=0.01), 0.0)


def test_structures_have_the_sizes_of_sdls() -> None:
    assert (ctypes.sizeof(_Constant), ctypes.sizeof(_Condition), ctypes.sizeof(_Effect)) == (40, 68, 72)


def test_joystick_without_a_motor_says_so_and_works(plugged: VirtualCockpit, source: SdlSource) -> None:
    number = source.instance_id("wheel")
    assert number is not None
    port = open_haptics(number, FORCE)
    assert not port.capability.constant
    assert "value none: a driver with force feedback" in port.capability.name
    port.write(1.0)
    port.start()
    port.stop()
    port.close()
    plugged.unplug("wheel")
    source.poll(1)
    assert source.instance_id("wheel") is None


def test_joystick_that_is_not_there_has_no_motor(sdl: None) -> None:
    from simconsole.devices.sources import sdl_runtime

    sdl_runtime.acquire()
    try:
        assert not open_haptics(4711, FORCE).capability.constant
    finally:
        sdl_runtime.release()


@pytest.mark.parametrize("back_end", ["sdl", "evdev"])
def test_in_a_pause_there_is_no_force_and_after_it_force_comes_slowly(back_end: str, tmp_path: Path) -> None:
    """The car's pull through the console's own kernel and motor to the device's driver, paused and started again."""
    log = tmp_path / "calls.jsonl"
    done = start(log, "pause", back_end)
    out, err = done.communicate(timeout=PATIENCE_S)
    assert done.returncode == 0, out + err
    said = {line.rpartition(" ")[0]: line.rpartition(" ")[2] for line in out.splitlines()}
    stands_ns, on_ns = int(said["stands"]), int(said["goes on"])
    assert on_ns - stands_ns > 0.35e9, "longer than an effect lasts: nothing may keep it going"
    told = calls(log)
    (slot,) = {call["id"] for call in told if call["what"] == "upload" and call["type"] == FF_CONSTANT}
    force = [call for call in told if call.get("id") == slot and call["what"] in ("upload", "play")]
    before = [call for call in force if call["t_ns"] <= stands_ns]
    pulls = [abs(call["level"]) for call in before if call["what"] == "upload"]
    assert max(pulls) > 0.5 * 32767, "there was force to end"
    assert pulls[-1] == 0
    assert [call["value"] for call in before if call["what"] == "play"][-1] == 0
    assert [call for call in force if stands_ns < call["t_ns"] < on_ns] == []
    after = [call for call in force if call["t_ns"] >= on_ns]
    soon = [abs(call["level"]) for call in after if call["what"] == "upload" and call["t_ns"] < on_ns + 0.1e9]
    assert any(call["what"] == "play" and call["value"] == 1 for call in after)
    assert max(soon) < 0.35 * max(pulls)
