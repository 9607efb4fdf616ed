"""Every fault at three places of the course: the car ends in its lane, at rest or with a person, and says why."""

from typing import Any

import numpy as np
import pytest

from simconsole.profiles.faults import Unplug, fault_label
from simconsole.values.labels import mode_label, reason_label
from simconsole.values.signals import Mode, Reason
from tests.faults import cases, figures
from tests.faults.cases import CASES, Case
from tests.faults.catalogue import CATALOGUE
from tests.faults.course import BY_HAND_ALONE, CAR_M, HZ, LANE_M, PLACES, WATCHED, circuit

IN_LANE_M = 0.5 * (LANE_M - CAR_M)


def marked(case: Case) -> Any:
    """Return a case as a parameter, with a mark for each of its ids."""
    marks = [pytest.mark.fault(number) for number in case.number.split()]
    return pytest.param(case, marks=marks, id=f"{case.number} {case.fault}".replace(" ", "-"))


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("case", [marked(case) for case in CASES])
def test_fault_at_a_place(case: Case, place: str) -> None:
    driven, fault, after_ms, found = cases.drive(case, place)
    print(f"{place}: {driven.modes}, {driven.lateral_m:.2f} m from the lane's centre, after {after_ms} ms")
    assert [span["fault"] for span in found["faults"]] == [fault_label(fault)]
    assert abs(driven.lateral_m) <= IN_LANE_M
    before = Mode.MANUAL if case.crew.by_hand else Mode.AUTONOMOUS
    if case.reaction is None or case.reason is None:
        assert driven.modes == [before]
        return
    assert driven.modes[:2] == [before, case.reaction]
    assert after_ms is not None
    assert after_ms <= case.promised_ms
    assert driven.at_rest
    assert driven.modes[-1] is Mode.STOPPED
    told = [(change["mode"], change["reason"]) for change in found["mode_changes"]]
    assert (mode_label(case.reaction), reason_label(case.reason)) in told


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("case", [marked(case) for case in CASES if case.watched])
def test_a_person_who_watches_takes_over_from_a_controller_at_fault(case: Case, place: str) -> None:
    driven, _, after_ms, _ = cases.drive(case, place, WATCHED)
    print(f"{place}: {driven.modes}, {driven.lateral_m:.2f} m from the lane's centre, after {after_ms} ms")
    assert driven.modes == [Mode.AUTONOMOUS, Mode.MINIMAL_RISK, Mode.MANUAL]
    assert driven.at_rest
    assert abs(driven.lateral_m) <= IN_LANE_M


def test_the_page_is_the_drives_and_the_catalogue() -> None:
    """All but the last column, which holds what differs from run to run."""
    text = figures.PAGE.read_text("utf-8")
    measured = figures.cells(text)
    assert text == cases.page() + figures.table(measured)
    assert set(measured) == {case.number for case in CATALOGUE}
    assert "-" not in measured.values(), "a case without a test that passed: make faults"


@pytest.mark.fault("R06")
def test_r06_a_controller_that_drives_the_whole_course_asks_for_nothing_implausible() -> None:
    whole = circuit().whole
    assert whole.column("vehicle.distance_m")[-1] > 2_000.0
    assert whole.column("ros_link.implausible")[-1] == 0.0


@pytest.mark.fault("R06")
@pytest.mark.parametrize("place", PLACES)
def test_r06_a_refused_command_never_moves_the_wheels(place: str) -> None:
    """While it is refused, and after: the angle only goes back to straight."""
    for case in (case for case in CASES if case.number == "R06"):
        driven = cases.drive(case, place).driven
        began = int(np.flatnonzero(driven.column("events.faults"))[0])
        angle = driven.column("command.road_wheel_rad")[began - 1 :]
        refused = driven.column("ros_link.implausible_ticks")[began:] > 0.0
        assert refused[0]
        assert (np.diff(np.abs(angle)) <= 0.0).all()
        assert (driven.column("arbitration.refusal")[began:][:20] == Reason.REFUSED_IMPLAUSIBLE).all()


@pytest.mark.fault("D01")
@pytest.mark.parametrize("place", PLACES)
def test_d01_a_wheel_that_is_back_in_a_bend_gives_control_back(place: str) -> None:
    """Half a second without a wheel, then the person brakes: theirs again, in the lane."""
    track = circuit()
    state = track.state_at(PLACES[place])
    lost = Unplug(device="wheel", at_s=state.tick / HZ + 1.0, for_s=0.5)
    driven = track.drive(state, 6.0, [lost], BY_HAND_ALONE._replace(attentive=True))
    assert driven.modes[:3] == [Mode.MANUAL, Mode.MINIMAL_RISK, Mode.MANUAL]
    assert np.abs(driven.lateral_m) <= IN_LANE_M
