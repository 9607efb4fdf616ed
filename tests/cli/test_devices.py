import json
from pathlib import Path
from typing import Final

from simconsole import __version__
from tests.drives.console import complaint, results, simconsole

FIRST_STEPS: Final = ("find", "calibrate", "feel", "identify", "rest")
LAST_STEPS: Final = ("gears", "buttons", "latency", "hot-plug", "emergency stop")


def test_devices_list_shows_a_virtual_cockpit() -> None:
    done = simconsole("devices", "list", "--virtual", "--json")
    assert done.returncode == 0, done.stderr
    assert {device["usb_id"]: device["roles"] for device in results(done)["devices"]} == {
        "044f:b65e": ["wheel", "pedals"],
        "044f:b660": ["shifter"],
    }
    assert "044f:b65e" in done.stderr


def test_devices_list_without_a_cockpit_fails_and_says_so() -> None:
    done = simconsole("devices", "list")
    assert done.returncode == 1
    assert "nothing connected for wheel, pedals, shifter" in done.stdout


def test_devices_check_without_a_cockpit_is_one_line() -> None:
    assert "044f:b65e" in complaint(simconsole("devices", "check", "--for", 1))


def test_devices_accept_of_a_virtual_cockpit_writes_its_report_and_its_profile(tmp_path: Path) -> None:
    folder = tmp_path / "acceptance"
    done = simconsole("devices", "accept", "--virtual", "--weight", 0.8, "--out", folder, "--json")
    assert done.returncode == 0, done.stdout + done.stderr
    report = json.loads((folder / "report.json").read_text("utf-8"))
    assert report["ok"], [step for step in report["steps"] if not step["ok"]]
    names = [step["name"] for step in report["steps"]]
    assert names == [*FIRST_STEPS, *(f"axis {axis}" for axis in ("throttle", "brake", "clutch", "wheel")), *LAST_STEPS]
    steps = {step["name"]: step["figures"] for step in report["steps"]}
    assert steps["identify"]["scale"].startswith("a weight of 0.8 kg")
    assert sum(steps["latency"]["at_most"].values()) >= steps["latency"]["readings"] > 0
    assert report["virtual"] is True
    assert report["host"]["simconsole"] == __version__
    assert report["provenance"]["force_feedback.motor"]["status"] == "captured"
    assert results(done) == report
    for name in names:
        assert name in done.stdout
    checked = simconsole("devices", "check", "--virtual", "--for", 1, "--cockpit", folder / "cockpit.yaml", "--json")
    assert checked.returncode == 0, checked.stdout + checked.stderr
    assert results(checked)["ok"] is True
