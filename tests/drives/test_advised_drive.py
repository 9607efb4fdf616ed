"""A drive of the autopilot by speed advice in lockstep: its log has what it went by, its report what that brought."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from simconsole.evaluation.metrics.drive_metrics import metrics
from simconsole.evaluation.metrics.table import recorded_drive
from simconsole.evaluation.report.page import page
from simconsole.recording.bundles.bundle import Bundle, open_bundle
from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.recording.log_header import ADVICE
from simconsole.recording.recorded_advice import AdviceAt, recorded_advice
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from simconsole.values.signals import Mode
from simconsole.world.rules.speed_advice import LEAST_MPS, Advised
from tests.drives.random_courses import SCRIPT

SESSION = """\
schema: 1
environment: {world: urban_signals}
scenario: {vehicle: hatchback, duration_s: SECONDS, start: {x_m: 120}}
features: {autopilot: urban_signals, speed_advice: true}
outputs: {hud: null, scene: null, report: false, bridge: {port: 0}}
devices: {driver: "script:asks.yaml"}
mode: {pacing: lockstep, answer_timeout_s: 60}
"""
AGAIN_S = 12


def driven(folder: Path, seconds: int) -> Bundle:
    folder.mkdir(exist_ok=True)
    (folder / "asks.yaml").write_text(SCRIPT)
    (folder / "session.yaml").write_text(SESSION.replace("SECONDS", str(seconds)))
    return open_bundle(drive(resolve(load_session(str(folder / "session.yaml"))), folder / "bundle").folder)


@pytest.fixture(scope="module")
def advised(tmp_path_factory: pytest.TempPathFactory) -> Bundle:
    return driven(tmp_path_factory.mktemp("advised"), 41)


def test_what_it_went_by_is_in_the_log_and_it_drove_so(advised: Bundle) -> None:
    told, table = list(recorded_advice(advised.log)), advised.log.table()
    assert all(_words(before) != _words(after) for before, after in pairwise(told))
    speeds = [one for one in told if one.kind == Advised.SPEED]
    assert speeds
    limit_mps = table.column("situation.speed_limit_mps").max()
    assert all(LEAST_MPS <= one.low_mps <= one.high_mps <= limit_mps for one in speeds)
    assert (table.column("arbitration.mode") == Mode.AUTONOMOUS).any()
    assert not table.column("rules.red_light").any()
    assert replay_bundle(advised.folder).hashes_equal


def test_the_report_tells_of_compliance_and_benefit(advised: Bundle) -> None:
    found = metrics(recorded_drive(advised.log), None)
    advice = found["speed_advice"]
    assert advice["lights"] == advice["advised"] == 1
    assert advice["compliance"] > 0.8
    assert advice["followed"]["lights"] == 1
    assert advice["followed"]["waiting_s"] == 0.0
    assert advice["followed"]["energy_jpkg"] > 0.0
    html = page("t", found, (), {}, {})
    assert "Advised before 1 of 1 lights" in html


def test_equal_drives_have_equal_logs(advised: Bundle, tmp_path: Path) -> None:
    again = driven(tmp_path / "again", AGAIN_S).log
    ticks = len(again.table().ticks)
    assert np.array_equal(again.table().vectors, advised.log.table().vectors[:ticks])
    told = list(again.messages(ADVICE))
    assert told
    assert told == [message for message in advised.log.messages(ADVICE) if message.tick <= ticks]


def _words(one: AdviceAt) -> tuple[float, ...]:
    return one.kind, one.low_mps, one.high_mps
