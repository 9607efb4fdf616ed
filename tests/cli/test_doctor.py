import sys

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
        assert f"  {name} " in done.stdout
