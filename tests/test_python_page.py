"""The code of docs/python.md runs as it stands there, each block after those before it."""

import re
from pathlib import Path

import pytest

from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.strict_yaml import parse
from simconsole.profiles.validation import convert
from simconsole.profiles.vehicle import OwnProfile
from tests.paths import ROOT
from tests.vehicle.fmu.building import build

PAGE = ROOT / "docs" / "python.md"


def blocks(language: str) -> list[tuple[int, str]]:
    """The blocks of a language in the page, each with the line on which it begins."""
    text = PAGE.read_text("utf-8")
    fence = re.compile(rf"^```{language}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
    return [(text.count("\n", 0, found.start()) + 1, found[1]) for found in fence.finditer(text)]


def test_its_python_runs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "page"}
    found = blocks("python")
    assert len(found) >= 2
    for line, text in found:
        exec(compile("\n" * line + text, str(PAGE), "exec"), names)
    assert (names["drive"].column("own.gain")[10:] == 2.0).all()  # type: ignore[attr-defined]
    assert names["icy"].profile.environment.friction == 0.3  # type: ignore[attr-defined]


def test_its_profiles_are_profiles(tmp_path: Path) -> None:
    """The session's part is one, and the FMU's profile loads once the unit lies beside it."""
    session, fmu = (text for _, text in blocks("yaml"))
    profile = convert({"schema": 1, **parse(session, "page")}, SessionProfile, "page")  # type: ignore[dict-item]
    assert profile.features.controller is not None
    assert profile.features.controller.parameters == {"speed_mps": 7.0}
    (tmp_path / "car.fmu").write_bytes((build(tmp_path, 2).parent / "car2.fmu").read_bytes())
    (tmp_path / "car.yaml").write_text(fmu)
    vehicle = load_vehicle(str(tmp_path / "car.yaml"))
    assert isinstance(vehicle, OwnProfile)
    assert vehicle.names["road_wheel_rad"] == "delta"
