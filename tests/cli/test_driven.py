"""The end of `simconsole demo` and `simconsole drive`: what is printed and with which code, with exports by hand."""

from pathlib import Path
from typing import Any

import pytest

from simconsole.cli import driven
from simconsole.cli.driven import finish
from simconsole.evaluation.report.exports import Told
from simconsole.recording.bundles.pack import Sizes
from simconsole.session.lifecycle import DriveResult
from simconsole.values.errors import RecordingError

SUMMARY = {"lateness": "p99 0.1 ms", "real_time_factor": 12.34}
PART = {"distance_m": 90.0, "mean_speed_kmh": 36.0, "lateral_rms_m": 0.0123, "lateral_max_m": 0.2}
METRICS = {
    "distance_m": 100.0,
    "duration_s": 12.0,
    "autonomous": PART,
    "manual": {"distance_m": 10.0, "lateral_rms_m": 0.03, "lateral_deviation_m": 0.0234, "lateral_max_m": 0.1},
    "rules": [],
    "road": {"whole": {"lights_passed": 5, "lights_stood_at": 3, "let_pass": 2}},
    "force_feedback": {"least_share": 0.82, "least_at_kmh": 131.0, "eased_s": 4.5, "eased_from_s": 2.0},
    "mode_changes": [{"t_s": 1.5, "mode": "MANUAL", "reason": "controls ready"}],
}


def result(**changes: Any) -> DriveResult:
    drive = DriveResult(Path("out/it"), ticks=5, digest="ab", interrupted=False, summary=SUMMARY)
    return drive._replace(**changes)


@pytest.fixture
def wanted(monkeypatch: pytest.MonkeyPatch) -> list[tuple[bool, bool]]:
    """What was to be written, each time."""
    calls: list[tuple[bool, bool]] = []

    def write_exports(folder: Path, report: bool, scene: bool, told: Told) -> dict[str, Any]:
        calls.append((report, scene))
        return METRICS

    monkeypatch.setattr(driven, "write_exports", write_exports)
    monkeypatch.setattr(driven, "_link", lambda result: "perfect")
    monkeypatch.setattr(driven, "pack", lambda folder, watch: Sizes(122_400_000, 17_400_000))
    return calls


def test_broken_rules_are_counted(wanted: list[tuple[bool, bool]], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(METRICS, "rules", [{"rule": "red_light"}, {"rule": "speeding"}, {"rule": "red_light"}])
    assert "red light passed: 2, speed limit exceeded: 1" in finish(result(), scene=False).text
    monkeypatch.setitem(METRICS, "road", None)
    assert "red light" not in finish(result(), scene=False).text
    assert len(wanted) == 2


def test_a_good_drive_is_told_in_a_table(wanted: list[tuple[bool, bool]]) -> None:
    outcome = finish(result(), scene=False)
    assert outcome.code == 0
    assert wanted == [(True, False)]
    lines = [line.split(maxsplit=1) for line in outcome.text.splitlines()]
    assert ["distance", "100.0 m"] in lines
    assert "RMS 1.23 cm, max 20.00 cm" in outcome.text
    assert "10.0 m, lateral error RMS 3.0 cm, max 10.0 cm, SD 2.3 cm" in outcome.text
    assert ["lights", "5 passed, stood at 3 of them"] in lines
    assert ["others", "somebody had to be let pass 2 times"] in lines
    assert ["rules", "none broken, nobody touched"] in lines
    assert "mode at    1.50 s" in outcome.text
    assert "eased to 82 % of the car's torque at 131 km/h, 4.5 s in all" in outcome.text
    assert "out/it/report.html" in outcome.text
    assert "scene.rrd" not in outcome.text
    assert ["packed", "17.4 MB, of a log of 122.4 MB"] in lines
    assert (outcome.results["digest"], outcome.results["distance_m"]) == ("ab", 100.0)


def test_an_interrupted_drive_has_code_130_and_a_failed_recording_1(
    wanted: list[tuple[bool, bool]], capsys: pytest.CaptureFixture[str]
) -> None:
    outcome = finish(result(interrupted=True))
    said = capsys.readouterr().err
    assert said.startswith("simconsole: the drive has ended and is whole in out/it; now packing it (--no-pack) and ")
    assert "the report" in said
    assert outcome.code == 130
    assert "12.0 s simulated, interrupted" in outcome.text
    assert finish(result(interrupted=True, recording_failure="no space")).code == 1


def test_where_the_log_failed_nothing_else_is_tried(wanted: list[tuple[bool, bool]]) -> None:
    outcome = finish(result(recording_failure="no space"))
    assert wanted == [(False, False)]
    assert outcome.results["exports_failure"] == "not tried, for the recording failed"
    assert "RECORDING FAILED" in outcome.text
    assert "no space" in outcome.text


def refuse(folder: Path, watch: object) -> Sizes:
    raise AssertionError("packed")


def test_what_shall_not_be_packed_is_not(wanted: list[tuple[bool, bool]], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(driven, "pack", refuse)
    for outcome in (
        finish(result(), packed=False),
        finish(result(recording_failure="no space")),
        finish(result(ticks=0)),
    ):
        assert "packed" not in outcome.text
        assert outcome.results["packing_failure"] is None


def test_a_drive_that_cannot_be_packed_keeps_its_result(
    wanted: list[tuple[bool, bool]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(folder: Path, watch: object) -> Sizes:
        raise RecordingError("no space")

    monkeypatch.setattr(driven, "pack", fail)
    outcome = finish(result())
    assert outcome.code == 0
    assert outcome.results["packing_failure"] == "no space"
    assert ["packed", "no: no space"] in [line.split(maxsplit=1) for line in outcome.text.splitlines()]


def test_a_drive_without_a_tick_says_so(wanted: list[tuple[bool, bool]]) -> None:
    outcome = finish(result(ticks=0))
    assert wanted == []
    assert "out/it: no tick was recorded" in outcome.text


def test_a_report_that_cannot_be_written_does_not_spoil_the_drive(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(folder: Path, report: bool, scene: bool, told: Told) -> dict[str, Any]:
        raise MemoryError("too\nlittle")

    monkeypatch.setattr(driven, "write_exports", fail)
    outcome = finish(result(), packed=False)
    assert outcome.code == 0
    assert "not written: " in outcome.text
    assert "\n" not in outcome.results["exports_failure"]
    assert "real-time factor" in outcome.text
