import shutil
from pathlib import Path

import pytest

from simconsole.world.tools.shipped_maps import main
from tests.paths import ROOT

WORLDS = ROOT / "profiles" / "worlds"


def test_shipped_maps_are_what_the_tool_writes(tmp_path: Path) -> None:
    shutil.copy(WORLDS / "urban.yaml", tmp_path)
    assert main([str(tmp_path)]) == 0
    written = sorted(path.name for path in tmp_path.iterdir())
    assert {"country.net.xml", "motorway.yaml", "skid_pad.poly.xml", "urban_signals.net.xml"} <= set(written)
    for name in written:
        assert (tmp_path / name).read_bytes() == (WORLDS / name).read_bytes(), (
            "python -m ...shipped_maps profiles/worlds"
        )


def test_bad_usage_and_a_missing_course_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 2
    assert main([str(tmp_path)]) == 2
    assert capsys.readouterr().err.splitlines()[-1].startswith("error: ")
