import sys

import pytest

from simconsole.cli.doctor import doctor
from simconsole.cli.main import parser
from simconsole.world.sumo import netconvert
from simconsole.world.sumo_traffic import engines
from tests.drives.console import results, simconsole


def test_doctor_tells_what_is_there_and_what_is_not() -> None:
    done = simconsole("doctor", "--json")
    assert done.returncode == 0
    found = results(done)
    assert found["python"] == sys.version.split()[0]
    assert found["display"] == "no: no window; PNG works"
    assert found["numba"] != "missing"
    assert "any program of this machine may" in found["local programs"]
    assert "emergency stop" in found["local programs"]
    for name in found:
        assert f"  {name} " in done.stderr


def test_each_part_of_sumo_is_named_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    options = parser().parse_args(["doctor"])
    parts = ("libsumo", "traci", "program sumo", "netconvert")
    there = doctor(options).results
    assert there["libsumo"] == there["traci"] == "yes: 1.28.0", "one version"
    assert [there[part][:3] for part in parts] == ["yes"] * 4
    for missing, part in (("libsumo", "libsumo"), ("traci", "traci")):
        monkeypatch.setattr(engines, "has", lambda name, missing=missing: name != missing)
        found = doctor(options).results
        assert found[part] == f"no: environment.traffic.sumo with backend {part} needs the extra `sumo`"
        assert [one for one in parts if found[one].startswith("no")] == [part]
    monkeypatch.undo()
    monkeypatch.setattr(engines, "sumo_program", lambda: None)
    monkeypatch.setattr(netconvert, "netconvert", lambda: None)
    found = doctor(options).results
    assert [one for one in parts if found[one].startswith("no")] == ["program sumo", "netconvert"]
