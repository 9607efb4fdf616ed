"""Two cars with a person in each, out of each other's sight: what one does with theirs is nothing to the other's."""

from pathlib import Path

import numpy as np
import pytest

from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.manifest import read_manifest
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.reading import LogTable
from simconsole.session.fleet.fleet_drive import drive_fleet
from simconsole.session.resolution import load_session, resolve
from simconsole.values.signals import Mode

SESSION = """schema: 1
environment: {{world: urban}}
scenario:
  duration_s: 13
  platforms:
    - {{name: a, person: {{sit_s: 0.5, cruise_kmh: 15, top_gear: 2, autonomy: {{distance_m: 5}}{takes_back}}}}}
    - name: b
      start: {{x_m: 250.0, y_m: 0.0}}
      driver: virtual
      person: {{sit_s: 0.5, cruise_kmh: 15, top_gear: 2, autonomy: {{distance_m: 5}}}}
features: {{autopilot: urban}}
outputs: {{bridge: {{port: 0}}, hud: null, scene: null, report: false}}
devices: {{driver: virtual}}
mode: {{pacing: lockstep, answer_timeout_s: 60}}
"""


class Driven:
    def __init__(self, folder: Path, takes_back: str) -> None:
        folder.mkdir()
        (folder / "session.yaml").write_text(SESSION.format(takes_back=takes_back))
        self.bundle = folder / "bundle"
        self.result = drive_fleet(resolve(load_session(str(folder / "session.yaml"))), self.bundle)
        self.a, self.b = (open_bundle(one).log.table() for one in (self.bundle, self.bundle / "b"))


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Driven, Driven]:
    folder = tmp_path_factory.mktemp("two_people")
    return Driven(folder / "taken", ", take_back: {distance_m: 20}, stop: {distance_m: 1000}"), Driven(
        folder / "left", ""
    )


def modes(table: LogTable) -> list[int]:
    """The modes of a drive in their order."""
    mode = table.column("arbitration.mode").astype(int)
    return [int(mode[0]), *mode[1:][np.diff(mode) != 0].tolist()]


def test_each_person_hands_over_to_an_autopilot_of_their_own(drives: tuple[Driven, Driven]) -> None:
    for driven in drives:
        assert driven.result.summary["unanswered"] == 0
        assert read_manifest(driven.bundle / "b").summary["unanswered"] == 0
        apart_m = driven.b.column("vehicle.x_m") - driven.a.column("vehicle.x_m")
        assert apart_m.min() > 150.0, "so far nobody is followed"
        assert Mode.AUTONOMOUS in modes(driven.a)
        assert modes(driven.b)[-1] == Mode.AUTONOMOUS


def test_when_one_takes_over_the_other_drives_on_as_if_nobody_did(drives: tuple[Driven, Driven]) -> None:
    taken, left = drives
    assert modes(taken.a)[-1] == Mode.MANUAL
    assert modes(left.a)[-1] == Mode.AUTONOMOUS
    parts = ("arbitration.", "torque.", "command.", "vehicle.", "sample.", "motor.")
    columns = [column for column in taken.b.columns if column.startswith(parts)]
    assert {"arbitration.mode", "arbitration.remote_lateral", "torque.torque_nm"} <= set(columns)
    assert np.ptp(taken.b.column("torque.torque_nm")) > 0.1, "the wheel's motor works"
    different = [one for one in columns if taken.b.column(one).tobytes() != left.b.column(one).tobytes()]
    assert different == []


def test_each_chain_replays_alone(drives: tuple[Driven, Driven]) -> None:
    for folder in (drives[0].bundle, drives[0].bundle / "b"):
        found = replay_bundle(folder)
        assert found.hashes_equal, found.differences
