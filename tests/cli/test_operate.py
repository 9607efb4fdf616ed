"""An operator at work: `simconsole operate` in a paced drive, and the bundle that is left of it."""

import json
from pathlib import Path

import numpy as np
import pytest

from simconsole.cli.main import main
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.log import LogReader
from simconsole.values.signals import Event, Mode
from tests.drives.console import Running, results, simconsole, within
from tests.interop.programs import wait_for_port
from tests.patience import PATIENCE_S, wait_until
from tests.ports import free_port

SESSION = """schema: 1
scenario: {vehicle: hatchback, duration_s: 4}
features: {control: {person_required: false}}
outputs: {bridge: {port: PORT}, hud: null, scene: null, report: false}
devices: {driver: none}
mode: {pacing: realtime, start: on_request}
"""


def test_acts_of_an_operator_are_in_the_drive_and_in_its_bundle(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    session, bundle = tmp_path / "session.yaml", tmp_path / "bundle"
    port = free_port()
    session.write_text(SESSION.replace("PORT", str(port)))

    url = f"ws://127.0.0.1:{port}"

    def operate(*arguments: str) -> int:
        done = simconsole("operate", *arguments, "--url", url, "--json")
        return int(results(done)["tick"]) if done.returncode == 0 else -1

    def at_once(*arguments: str) -> int:
        """The same while simulated time goes on: no program has to be started, which takes seconds beside others."""
        assert main(["operate", *arguments, "--url", url, "--json"]) == 0
        return int(json.loads(capsys.readouterr().out.splitlines()[-1])["tick"])

    with Running(tmp_path / "output", "drive", session, "--out", bundle, "--no-pack") as drive:
        wait_for_port(port)
        wait_until(lambda: operate("mark") == 1, "the first tick")
        assert operate("start", "--participant", "P07", "--trial", "B-3") == 1, "simulated time stood until now"
        paused = at_once("pause", "--note", "phone rang")
        assert 0 <= at_once("mark", "--note", "while time stands") - paused < 100
        at_once("start")
        at_once("estop")
        assert drive.end().returncode == 0, drive.end().stderr
    opened = open_bundle(bundle)
    acts = opened.manifest.summary["acts"]
    assert [entry["act"] for entry in acts][-5:] == ["start", "pause", "mark", "start", "estop"]
    assert [entry.get("note") for entry in acts][-4:-2] == ["phone rang", "while time stands"]
    assert (opened.manifest.summary["participant"], opened.manifest.summary["trial"]) == ("P07", "B-3")
    recorded = [(message.tick, json.loads(message.content)) for message in opened.log.messages("acts")]
    assert [act for _, act in recorded] == acts
    assert all(tick > act["tick"] for tick, act in recorded)
    table = opened.log.table()
    events = table.column("events.events").astype(int)
    pauses = np.flatnonzero(events & Event.PAUSE)
    assert pauses.tolist()[0] == 0, "the first tick waits for its start"
    assert len(pauses) == 2
    assert (events[pauses + 1] & Event.START).all()
    assert events[pauses[1] + 1] & Event.MARK, "asked for while time stood"
    assert len(events) == 1000, "four seconds were driven, whatever the clock on the wall said"
    stopped = np.flatnonzero(events & Event.EMERGENCY_STOP)
    assert table.column("arbitration.mode")[stopped[0]] == Mode.EMERGENCY_STOP
    assert within("replay", bundle).returncode == 0


def test_what_an_operator_wrote_outlives_a_drive_that_is_killed(tmp_path: Path) -> None:
    session, bundle = tmp_path / "session.yaml", tmp_path / "bundle"
    port = free_port()
    session.write_text(SESSION.replace("PORT", str(port)).replace("duration_s: 4", "duration_s: 400"))

    def operate(*arguments: str) -> int:
        return simconsole("operate", *arguments, "--url", f"ws://127.0.0.1:{port}", "--json").returncode

    with Running(tmp_path / "output", "drive", session, "--out", bundle, "--no-pack") as drive:
        wait_for_port(port)
        wait_until(lambda: operate("start", "--participant", "P07", "--trial", "B-3") == 0, "the console")
        assert operate("mark", "--note", "cut in") == 0
        ticks = sum(1 for _ in LogReader(bundle / "drive.log"))
        wait_until(lambda: sum(1 for _ in LogReader(bundle / "drive.log")) > ticks + 1, "two ticks more")
        drive.process.kill()
        drive.process.wait(PATIENCE_S)
    opened = open_bundle(bundle)
    assert not opened.manifest.finished
    acts = [json.loads(message.content) for message in opened.log.messages("acts")]
    assert [{**act, "tick": None} for act in acts] == [
        {"tick": None, "act": "start", "participant": "P07", "trial": "B-3"},
        {"tick": None, "act": "mark", "note": "cut in"},
    ]
    assert within("replay", bundle).returncode == 0
