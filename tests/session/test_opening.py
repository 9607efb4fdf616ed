import re
from pathlib import Path

import pytest
import yaml

from simconsole.cli.main import main


@pytest.mark.parametrize(
    ("bridge", "words"),
    [
        ({"upstream": {"url": "ws://robot:9090"}}, r"value free .*: realtime, where outputs\.bridge\.upstream"),
        ({"ros2": {}}, r"value free .*: lockstep or realtime, where outputs\.bridge\.ros2"),
    ],
)
def test_links_that_a_drive_without_a_bridge_has_not_are_refused(
    bridge: dict[str, object], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "session.yaml"
    outputs = {"bridge": bridge, "hud": None, "scene": None, "report": False}
    told = {"schema": 1, "outputs": outputs, "devices": {"driver": "none"}, "mode": {"pacing": "free"}}
    path.write_text(yaml.safe_dump(told))
    assert main(["drive", str(path), "--headless", "--for", "1", "--out", str(tmp_path / "bundle")]) == 2
    assert re.search(rf"mode\.pacing: {words}", capsys.readouterr().err)
