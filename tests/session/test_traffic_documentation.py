"""The session that docs/traffic.md shows is driven as it stands there."""

from pathlib import Path

from simconsole.recording.bundles.replay_bundle import replay_bundle
from simconsole.session.lifecycle import drive
from simconsole.session.resolution import load_session, resolve
from tests.paths import ROOT


def test_example_is_driven_on_sumo(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "traffic.md").read_text().partition("```yaml\n")[2].partition("```")[0]
    (tmp_path / "session.yaml").write_text(text)
    result = drive(resolve(load_session(str(tmp_path / "session.yaml"))), tmp_path / "bundle")
    assert result.summary["traffic"]["ego_error_m"] == 0.0
    assert "lost" not in result.summary["traffic"]
    assert replay_bundle(result.folder).hashes_equal
