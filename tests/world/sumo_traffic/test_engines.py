"""Where SUMO is looked for, and what is said of one that is not there."""

import os
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from simconsole.profiles.traffic import SumoProfile
from simconsole.values.errors import ProfileError
from simconsole.world.sumo_traffic import engines
from simconsole.world.sumo_traffic.engines import missing, open_engine, said_by, sumo_program


def test_nothing_is_missing_where_the_extra_is_installed() -> None:
    assert missing(SumoProfile(backend="libsumo")) is None
    assert missing(SumoProfile(backend="traci")) is None
    assert sumo_program() is not None


def test_program_is_needed_only_where_none_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(engines, "sumo_program", lambda: None)
    assert missing(SumoProfile(backend="traci")) == "the program sumo: the extra `sumo`, or SUMO itself"
    assert missing(SumoProfile(backend="traci", address="sim:8813")) is None
    assert missing(SumoProfile(backend="libsumo")) is None


def test_address_where_nobody_listens_is_told() -> None:
    with socket.socket() as nobody:
        nobody.bind(("127.0.0.1", 0))  # taken, and never listens
        address = f"127.0.0.1:{nobody.getsockname()[1]}"
        with pytest.raises(ProfileError, match=rf"sumo\.address: value {address}: a SUMO that listens"):
            open_engine(SumoProfile(backend="traci", address=address, timeout_s=0.1), [])


def test_options_that_sumo_refuses_are_told_and_leave_room_for_the_next() -> None:
    for backend in ("libsumo", "traci"):
        with pytest.raises(ProfileError, match=r"environment\.traffic\.sumo: SUMO: .*: a simulation that starts"):
            open_engine(SumoProfile(backend=backend), ["--no-such-option"])
    assert engines._running == []


def test_nothing_is_said_by_a_sumo_of_somebody_else() -> None:
    assert said_by(None) == ""


def slow_sumo(folder: Path) -> str:
    """A SUMO that loads a country: it says its number into the pipe `folder`/told, which it holds until it ends."""
    program = folder / "sumo"
    program.write_text(f'#!/bin/sh\nexec >"{folder / "told"}"\necho $$\nexec sleep 600\n')
    program.chmod(0o755)
    os.mkfifo(folder / "told")
    return str(program)


def test_a_sumo_that_loads_ends_with_who_has_started_it_however_that_ends(tmp_path: Path) -> None:
    starts = (
        "import sys; from simconsole.world.sumo_traffic import engines;"
        "from simconsole.profiles.traffic import SumoProfile;"
        "engines.sumo_program = lambda: sys.argv[1];"
        "engines.open_engine(SumoProfile(backend='traci'), [])"
    )
    words = [sys.executable, "-c", starts, slow_sumo(tmp_path)]
    with subprocess.Popen(words) as core, (tmp_path / "told").open() as told:
        assert int(told.readline()) > 0
        core.kill()
        assert told.read() == "", "its end, when nobody holds the pipe any more"


def test_an_interrupt_while_it_loads_ends_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program, started = slow_sumo(tmp_path), list[subprocess.Popen[bytes]]()

    def connect(port: int, *, proc: subprocess.Popen[bytes], **_: object) -> None:
        started.append(proc)
        raise KeyboardInterrupt

    monkeypatch.setattr(engines, "sumo_program", lambda: program)
    monkeypatch.setattr("traci.connect", connect)
    with pytest.raises(KeyboardInterrupt):
        open_engine(SumoProfile(backend="traci"), [])
    assert started[0].returncode is not None
