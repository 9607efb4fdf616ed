"""`simconsole devices` as functions, with virtual devices and no waiting."""

from pathlib import Path

import pytest

from simconsole.devices.calibration.cockpit_check import CockpitCheck
from simconsole.devices.setup.device_commands import check_devices, list_devices, realtime, record_devices
from simconsole.devices.sources.trace_files import TraceSource
from simconsole.profiles.device import CockpitProfile
from simconsole.values.errors import DeviceNotFound
from tests.devices.calibration_run import CalibrationRun

pytestmark = pytest.mark.usefixtures("sdl")


def at_once(tick: int) -> None:
    return


class Paper:
    """Collects what a command says."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def __call__(self, line: str) -> None:
        self.lines.append(line)


def test_list_names_devices_and_their_roles(t500: CockpitProfile) -> None:
    paper = Paper()
    results = list_devices(t500, say=paper, virtual=True)
    assert {device["usb_id"]: device["roles"] for device in results["devices"]} == {
        "044f:b65e": ["wheel", "pedals"],
        "044f:b660": ["shifter"],
    }
    assert results["missing_roles"] == []
    assert any("044f:b660" in line and "shifter" in line for line in paper.lines)


def test_list_without_devices_says_what_is_missing(t500: CockpitProfile) -> None:
    paper = Paper()
    assert list_devices(t500, say=paper)["missing_roles"] == ["wheel", "pedals", "shifter"]
    assert "nothing connected for wheel, pedals, shifter" in paper.lines[-1]


def test_check_of_a_good_cockpit_finds_everything(t500: CockpitProfile) -> None:
    results = check_devices(t500, say=Paper(), duration_s=10.0, virtual=True, pace=at_once)
    assert results["ok"]
    assert results["problems"] == results["notes"] == []
    assert len(results["buttons"]) == 16
    assert results["gears"] == [-1, 0, 1, 2, 3, 4, 5, 6, 7]
    assert results["pedals"]["clutch"]["most"] == pytest.approx(1.0, abs=0.02)
    assert results["wheel_deg"]["most"] == pytest.approx(90.0, abs=2.0)


def test_check_says_what_was_not_tried(t500: CockpitProfile) -> None:
    results = check_devices(t500, say=Paper(), duration_s=0.2, virtual=True, pace=at_once)
    assert results["ok"]
    assert "the wheel was not turned" in results["notes"]
    assert any(note.startswith("gears not tried: 1, 2") for note in results["notes"])


def test_missing_devices_stop_check_and_record_and_spare_the_old_trace(t500: CockpitProfile, tmp_path: Path) -> None:
    path = tmp_path / "trace.csv"
    path.write_text("precious")
    with pytest.raises(DeviceNotFound):
        record_devices(t500, path, say=Paper(), duration_s=1.0, pace=at_once)
    assert path.read_text() == "precious"
    with pytest.raises(DeviceNotFound):
        check_devices(t500, say=Paper(), duration_s=1.0, pace=at_once)


def test_recorded_trace_plays_what_the_devices_showed(t500: CockpitProfile, tmp_path: Path) -> None:
    path = tmp_path / "trace.csv"
    results = record_devices(t500, path, say=Paper(), duration_s=2.0, virtual=True, pace=at_once, name="t500rs_th8rs")
    assert results["ticks"] == 500
    source = TraceSource(path, tick_hz=250)
    calibration = CalibrationRun(CockpitCheck(t500, 250)._settings)
    throttle = [calibration.calibrate(source.poll(tick)).throttle for tick in range(1, 501)]
    source.close()
    assert max(throttle) == pytest.approx(1.0, abs=0.02)
    assert source.header.cockpit == "t500rs_th8rs"


def test_interrupted_recording_is_whole(t500: CockpitProfile, tmp_path: Path) -> None:
    def interrupted(tick: int) -> None:
        if tick == 101:
            raise KeyboardInterrupt

    path = tmp_path / "trace.csv"
    results = record_devices(t500, path, say=Paper(), duration_s=9.0, virtual=True, pace=interrupted)
    assert results["ticks"] == 100
    source = TraceSource(path, tick_hz=250)
    assert [source.poll(tick).wheel_age_ticks for tick in (100, 150)] == [0.0, 0.0]
    source.close()


@pytest.mark.parametrize("late_s", [0.0, 0.3])
def test_real_time_pace_sleeps_until_each_ticks_deadline(late_s: float, monkeypatch: pytest.MonkeyPatch) -> None:
    now_s, slept_s = 50.0, list[float]()

    def sleep(length_s: float) -> None:
        nonlocal now_s
        slept_s.append(round(length_s, 9))
        now_s += length_s + 0.001

    monkeypatch.setattr("simconsole.devices.setup.device_commands.time.monotonic", lambda: now_s)
    monkeypatch.setattr("simconsole.devices.setup.device_commands.time.sleep", sleep)
    wait = realtime(100)
    now_s += late_s
    for tick in range(1, 5):
        wait(tick)
    assert slept_s == ([0.01, 0.009, 0.009, 0.009] if late_s == 0.0 else []), "a late one waits for nothing"


def test_check_shows_live_bars_ten_times_a_second(t500: CockpitProfile) -> None:
    shown: list[list[str]] = []
    check_devices(t500, say=Paper(), duration_s=3.0, virtual=True, pace=at_once, show=shown.append)
    assert len(shown) == 30
    assert {len(lines) for lines in shown} == {6}
    throttle = [lines[1] for lines in shown]
    assert any("[" + "#" * 20 in line for line in throttle)
    assert any("  0%" in line and "[" + "." * 30 + "]" in line for line in throttle)
    assert any("+90.0 deg" in lines[0] for lines in shown)
