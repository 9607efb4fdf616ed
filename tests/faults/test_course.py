"""Every fault at three places of the course: the car ends in its lane, at rest or with a person, and says why."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.pipeline import advance_row
from simconsole.profiles.faults import words
from simconsole.recording.bundle import open_bundle
from simconsole.replaying import state_at
from simconsole.report.metrics import metrics
from simconsole.report.table import drive_of
from simconsole.rows import INPUT_WIDTH
from simconsole.signals import Mode
from simconsole.words import mode_words, reason_words
from tests.drives.console import results, simconsole
from tests.faults import cases
from tests.faults.cases import CASES, Case
from tests.faults.course import CAR_M, HZ, LANE_M, PLACES, circuit

IN_LANE_M = 0.5 * (LANE_M - CAR_M)
ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.number} {case.fault}".replace(" ", "-"))
def test_fault_at_a_place(case: Case, place: str) -> None:
    driven, fault, after_ms = cases.drive(case, place)
    found = metrics(drive_of(driven.rows, driven.columns, HZ, driven.first_tick), driven.course, None, [words(fault)])
    print(f"{place}: {driven.modes}, {driven.lateral_m:.2f} m from the lane's centre, after {after_ms} ms")
    assert [span["fault"] for span in found["faults"]] == [words(fault)]
    assert abs(driven.lateral_m) <= IN_LANE_M
    if case.reaction is None or case.reason is None:
        assert driven.modes == [Mode.AUTONOMOUS]
        return
    assert driven.modes[1] is case.reaction
    assert after_ms is not None
    assert after_ms <= case.promised_ms
    assert driven.at_rest
    assert driven.modes[-1] is (Mode.STOPPED if case.alone else Mode.MANUAL)
    told = [(change["mode"], change["reason"]) for change in found["mode_changes"]]
    assert (mode_words(case.reaction), reason_words(case.reason)) in told


def test_the_page_is_what_was_measured() -> None:
    assert (ROOT / "docs" / "faults.md").read_text("utf-8") == cases.page()


SESSION = """schema: 1
environment: {world: urban}
scenario:
  vehicle: hatchback
  duration_s: 45
  faults: [{kind: silent, at_distance_m: 120}]
features: {autopilot: urban}
outputs: {bridge: {port: 0}, hud: null, scene: null, report: false}
devices: {driver: "script:person.yaml"}
mode: {pacing: lockstep}
"""
PERSON = """points:
  - {time_s: 0.0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 3.0, press: [autonomous]}
"""


def test_a_whole_drive_over_the_websocket(tmp_path: Path) -> None:
    (tmp_path / "session.yaml").write_text(SESSION)
    (tmp_path / "person.yaml").write_text(PERSON)
    done = simconsole("drive", tmp_path / "session.yaml", "--out", tmp_path / "bundle", "--json")
    assert done.returncode == 0, done.stderr
    table = open_bundle(tmp_path / "bundle").log.table()
    modes = table.column("arbitration.mode")
    fault = int(np.flatnonzero(table.column("events.faults"))[0])
    stop = int(np.flatnonzero(modes == Mode.MINIMAL_RISK)[0])
    print(f"safe stop {(stop - fault) * 1000 / HZ:.0f} ms after the last command; {results(done).get('ticks')} ticks")
    assert 0 < (stop - fault) * 1000 / HZ <= 210
    assert modes[-1] == Mode.STOPPED
    assert abs(table.column("vehicle.vx_mps")[-1]) < 0.1
    place = circuit().course.project(table.column("vehicle.x_m")[-1], table.column("vehicle.y_m")[-1])
    assert abs(place.lateral_m) <= IN_LANE_M
    console, state = state_at(tmp_path / "bundle", 1000)
    row = state.row
    for recorded in table.rows[1000:2000]:
        row = advance_row(row, recorded[:INPUT_WIDTH], console)
        assert row.tobytes() == recorded.tobytes(), "a row of a bundle is a state to drive on from"
    report = results(simconsole("report", tmp_path / "bundle", "--json"))
    assert "autopilot went silent" in str(report)
