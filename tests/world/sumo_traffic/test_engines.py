"""Where SUMO is looked for, and what is said of one that is not there."""

import socket

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
