"""`simconsole demo --sumo`: its first seconds among SUMO's traffic; refused in a line without the extra."""

from pathlib import Path

import pytest

from simconsole.cli import demo
from simconsole.cli.main import main
from simconsole.cli.outcome import Outcome
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.log_header import SIGNALS
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.session.resolution import load_session, override
from simconsole.values.errors import ProfileError
from simconsole.world.sumo_traffic import engines


@pytest.mark.parametrize("more", [[], ["--realtime"]])
def test_sumo_moves_the_others_and_its_signals_hold(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, more: list[str]
) -> None:
    brief = override(load_session("demo"), scenario={"duration_s": 2.0}, outputs={"hud": None, "scene": None})
    monkeypatch.setattr(demo, "load_session", lambda name: brief)
    monkeypatch.setattr(demo, "finish", lambda result, packed: Outcome(0, result.summary))
    assert main(["demo", "--sumo", *more, "--out", str(tmp_path / "bundle")]) == 0
    bundle = open_bundle(tmp_path / "bundle")
    assert bundle.manifest.summary["traffic"]["ego_error_m"] == 0.0, "only SUMO has one"
    assert "lost" not in bundle.manifest.summary["traffic"]
    table = bundle.log.table(("ahead.approach", "ahead.traffic_lost"))
    assert len(table.ticks) == 500
    assert (table.column("ahead.approach") != 0.0).all(), "never the map's own programs"
    assert table.column("ahead.approach")[-1] > 0.0
    assert list(bundle.log.messages(SIGNALS))
    tables = [at.users for at in recorded_road_users(bundle.log)]
    assert min(map(len, tables)) > 0
    (first, *_, last) = ({user[0]: (user[2], user[3]) for user in users.tolist()} for users in tables)
    assert any(last[number] != place for number, place in first.items() if number in last), "somebody moves"


def test_without_the_extra_it_is_refused_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(engines, "find_spec", lambda name: None)
    assert main(["demo", "--sumo"]) == ProfileError.exit_code == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert told.err == "simconsole demo: command line: --sumo: value missing: libsumo, of the extra `sumo`\n"
