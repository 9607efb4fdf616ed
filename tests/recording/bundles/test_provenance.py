from datetime import UTC, datetime, timedelta

import pytest

from simconsole.recording.bundles.provenance import (
    Device,
    Given,
    Machine,
    Provenance,
    Source,
    TorqueShare,
    facts,
    utc_now,
)
from simconsole.values.errors import RecordingError


def test_what_is_said_of_a_drive_has_bounds() -> None:
    ok = Given(participant="P" * 64, trial="3 b", notes=("x" * 500, "zwei\nZeilen", ""))
    assert ok.checked() is ok


@pytest.mark.parametrize(
    ("given", "named"),
    [
        (Given(participant="P" * 65), "participant: value of 65 characters: up to 64"),
        (Given(trial="\n"), "trial: value '\\n': printable characters"),
        (Given(notes=("ok", "x" * 501)), "note: value of 501 characters: up to 500"),
        (Given(notes=("\udcff",)), "note: value '\\udcff': printable characters"),
        (Given(notes=("x",) * 21), "notes: value 21 of them: up to 20"),
    ],
)
def test_what_is_said_beyond_them_is_one_line(given: Given, named: str) -> None:
    with pytest.raises(RecordingError) as caught:
        given.checked()
    assert str(caught.value) == named


def test_time_is_utc_to_the_second() -> None:
    before = datetime.now(UTC) - timedelta(seconds=1)
    said = datetime.fromisoformat(utc_now())
    assert before <= said <= datetime.now(UTC)
    assert said.utcoffset() == timedelta(0)
    assert said.microsecond == 0


def test_facts_are_short_and_leave_out_what_nobody_told() -> None:
    assert facts(Provenance()) == {}
    machine = Machine(platform="Linux x86_64", kernel="6.1", cpu="Fast", cpus=8, python="CPython 3.11.7")
    known = Provenance(
        started_utc="2031-02-03T04:05:06+00:00",
        participant="P07",
        notes=("one", "two"),
        machine=machine,
        source=Source(version="1.2", sha256="a" * 64, commit="b" * 40, changed=True),
        devices=(Device(roles=("wheel", "pedals"), name="T500", usb_id="044f:b65e"),),
    )
    assert facts(known) == {
        "started": "2031-02-03T04:05:06+00:00",
        "participant": "P07",
        "notes": "one; two",
        "devices": "T500 (044f:b65e)",
        "machine": "Fast, 8 CPUs, Linux x86_64 6.1, CPython 3.11.7",
        "simconsole": "1.2, commit bbbbbbbbbbbb with changes, sources aaaaaaaaaaaa",
    }


def test_facts_say_from_which_speed_on_the_wheel_bears_a_share_of_the_cars_torque_only() -> None:
    shares = [TorqueShare(speed_kmh=speed, share=share) for speed, share in ((60.0, 1.0), (90.0, 0.998), (120.0, 0.81))]
    eased = facts(Provenance(torque_shares=tuple(shares)))
    assert eased == {"force feedback": "of the car's torque: 81 % at 120 km/h"}
    assert facts(Provenance(torque_shares=tuple(shares[:2])))["force feedback"].endswith("all up to 90 km/h")
