import math

import pytest

from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.link import watch_link
from simconsole.values.signals import NEVER_TICKS, Link, LinkState, RemoteCommand, RemoteKind, VehicleState

NO_LINK = Link(*(0.0,) * len(Link._fields))
VEHICLE = VehicleState(*(0.0,) * len(VehicleState._fields))
REMOTE = RemoteCommand(*(0.0,) * len(RemoteCommand._fields))._replace(kind=float(RemoteKind.SPEED), sequence=1.0)


def watch(
    remote: RemoteCommand, before: Link, vehicle: VehicleState, settings: ControlSettings, age_before_ticks: float = 0.0
) -> Link:
    return watch_link(remote, before, age_before_ticks, vehicle, settings)


@pytest.mark.parametrize(
    ("fields", "fresh"),
    [
        ({}, 1.0),
        ({"age_ticks": 49.0}, 1.0),
        ({"age_ticks": 50.0}, 0.0),
        ({"age_ticks": NEVER_TICKS}, 0.0),
        ({"age_ticks": -1.0}, 0.0),
        ({"sequence": 0.0}, 0.0),
        ({"kind": 0.0}, 0.0),
        ({"kind": 17.0}, 0.0),
    ],
)
def test_fresh(fields: dict[str, float], fresh: float, control: ControlSettings) -> None:
    link = watch(REMOTE._replace(**fields), NO_LINK, VEHICLE, control)
    assert (link.fresh, link.fresh_ticks, link.invalid) == (fresh, fresh, 0.0)


def test_refused_commands_count_in_a_row(control: ControlSettings) -> None:
    link = watch(REMOTE, NO_LINK, VEHICLE, control)
    for refused in range(1, 6):
        link = watch(REMOTE._replace(refused=float(refused)), link, VEHICLE, control)
        assert (link.invalid_run, link.fresh_ticks) == (float(refused), 0.0)
        assert link.invalid == (1.0 if refused == 5 else 0.0)
    link = watch(REMOTE._replace(refused=5.0, sequence=2.0), link, VEHICLE, control)
    assert (link.invalid_run, link.invalid, link.fresh_ticks) == (0.0, 0.0, 1.0)


def test_a_controller_that_was_invalid_begins_to_be_steady_only_when_it_is_valid_again(
    control: ControlSettings,
) -> None:
    """Its last command stays fresh meanwhile: the first good one after it must not find it steady."""
    link = watch(REMOTE._replace(refused=5.0), watch(REMOTE, NO_LINK, VEHICLE, control), VEHICLE, control)
    assert link.invalid == 1.0
    for age in range(1, int(control.engage_stable_ticks) + 9):
        link = watch(REMOTE._replace(refused=5.0, age_ticks=float(age)), link, VEHICLE, control)
        assert (link.fresh, link.invalid, link.fresh_ticks) == (1.0, 1.0, 0.0)
    link = watch(REMOTE._replace(refused=5.0, sequence=2.0), link, VEHICLE, control)
    assert (link.invalid, link.fresh_ticks, link.state) == (0.0, 1.0, LinkState.UNSTEADY)


def test_many_refused_in_one_tick_count_at_once(control: ControlSettings) -> None:
    link = watch(REMOTE, NO_LINK, VEHICLE, control)
    assert watch(REMOTE._replace(refused=5.0), link, VEHICLE, control).invalid == 1.0
    huge = watch(REMOTE._replace(refused=1e308), link, VEHICLE, control)
    assert (huge.invalid_run, huge.invalid) == (1e9, 1.0)


def test_a_counter_that_starts_anew_is_no_refusal(control: ControlSettings) -> None:
    link = watch(REMOTE._replace(refused=0.0), NO_LINK._replace(refused_seen=7.0, sequence_seen=1.0), VEHICLE, control)
    assert (link.refused_seen, link.invalid_run, link.fresh) == (0.0, 0.0, 1.0)


def test_a_command_that_is_no_number_is_invalid_and_remembered_as_nothing(control: ControlSettings) -> None:
    before = NO_LINK._replace(sequence_seen=3.0, refused_seen=2.0, invalid_run=1.0, fresh_ticks=99.0)
    for field in ("sequence", "refused", "speed_mps"):
        link = watch(REMOTE._replace(**{field: math.nan}), before, VEHICLE, control)
        assert link == (3.0, 2.0, 1.0, 0.0, 0.0, 1.0, 0.0, LinkState.INVALID, 0.0, 0.0)


def test_state_in_one_word(control: ControlSettings) -> None:
    assert watch(REMOTE._replace(sequence=0.0), NO_LINK, VEHICLE, control).state == LinkState.NEVER
    link = watch(REMOTE, NO_LINK, VEHICLE, control)
    assert link.state == LinkState.UNSTEADY
    for _ in range(int(control.engage_stable_ticks)):
        link = watch(REMOTE, link, VEHICLE, control)
    assert link.state == LinkState.STEADY
    almost = NO_LINK._replace(sequence_seen=1.0, fresh_ticks=control.engage_stable_ticks - 2.0)
    assert watch(REMOTE, almost, VEHICLE, control).state == LinkState.UNSTEADY
    steady = almost._replace(fresh_ticks=control.engage_stable_ticks - 1.0)
    assert watch(REMOTE, steady, VEHICLE, control).state == LinkState.STEADY
    assert watch(REMOTE._replace(age_ticks=50.0), link, VEHICLE, control).state == LinkState.STALE
    assert watch(REMOTE._replace(refused=5.0), link, VEHICLE, control).state == LinkState.INVALID


def test_a_fresh_command_renews_the_lease_and_nothing_else_does(control: ControlSettings) -> None:
    link = watch(REMOTE, NO_LINK, VEHICLE, control)
    assert link.lease_ticks == control.lease_ticks == 125.0
    link = watch(REMOTE._replace(age_ticks=50.0), link, VEHICLE, control)
    assert link.lease_ticks == 124.0
    link = watch(REMOTE._replace(speed_mps=math.inf), link, VEHICLE, control)
    assert link.lease_ticks == 123.0
    link = watch(REMOTE._replace(refused=9.0), link, VEHICLE, control)
    assert link.lease_ticks == 122.0
    for _ in range(200):
        link = watch(REMOTE._replace(age_ticks=NEVER_TICKS), link, VEHICLE, control)
    assert link.lease_ticks == 0.0


# At 10 m/s and a wheelbase of 2.6 m, 10 m/s2 of lateral acceleration are tan(angle) = 0.26.
AT_SPEED = VEHICLE._replace(vx_mps=10.0)
MEANT_RAD, WILD_RAD = math.atan(0.26) - 1e-6, math.atan(0.26) + 1e-6


def test_steering_that_cannot_be_meant_counts_as_refused(control: ControlSettings) -> None:
    """Each new command counts once, however long it is in force; a plausible one ends the row."""
    link = watch(REMOTE._replace(road_wheel_rad=MEANT_RAD), NO_LINK, AT_SPEED, control)
    assert (link.invalid_run, link.implausible, link.implausible_ticks, link.fresh_ticks) == (0.0, 0.0, 0.0, 1.0)
    for count in range(1, 6):
        wild = REMOTE._replace(road_wheel_rad=WILD_RAD, sequence=1.0 + count)
        link = watch(wild, link, AT_SPEED, control)
        assert (link.invalid_run, link.implausible, link.fresh, link.fresh_ticks) == (count, count, 1.0, 0.0)
        assert link.invalid == (1.0 if count == 5 else 0.0)
        again = watch(wild, link, AT_SPEED, control)
        assert again == link._replace(implausible_ticks=link.implausible_ticks + 1.0, lease_ticks=again.lease_ticks)
    assert (link.implausible_ticks, link.state, link.lease_ticks) == (5.0, LinkState.INVALID, 120.0)
    link = watch(REMOTE._replace(road_wheel_rad=MEANT_RAD, sequence=9.0), link, AT_SPEED, control)
    assert (link.invalid_run, link.implausible, link.implausible_ticks, link.fresh_ticks) == (0.0, 5.0, 0.0, 1.0)
    assert link.state == LinkState.UNSTEADY


def test_a_row_is_ended_by_a_plausible_command_only(control: ControlSettings) -> None:
    """Not by one of no known kind, and one that steers too hard counts though it comes too late to be in force."""
    four = watch(REMOTE._replace(refused=4.0), watch(REMOTE, NO_LINK, AT_SPEED, control), AT_SPEED, control)
    assert four.invalid_run == 4.0
    later = REMOTE._replace(refused=4.0, sequence=2.0)
    late = {"age_ticks": control.stale_ticks}
    assert watch(later._replace(kind=17.0), four, AT_SPEED, control).invalid_run == 4.0
    assert watch(later._replace(**late), four, AT_SPEED, control).invalid_run == 0.0
    wild = watch(later._replace(road_wheel_rad=1.0, **late), four, AT_SPEED, control)
    assert (wild.invalid_run, wild.invalid, wild.implausible, wild.implausible_ticks) == (5.0, 1.0, 1.0, 0.0)


def test_refused_and_implausible_ones_make_one_row(control: ControlSettings) -> None:
    link = watch(REMOTE, NO_LINK, AT_SPEED, control)
    link = watch(REMOTE._replace(refused=3.0), link, AT_SPEED, control)
    wild = REMOTE._replace(refused=3.0, sequence=2.0, road_wheel_rad=1.0)
    link = watch(wild, link, AT_SPEED, control)
    assert (link.invalid_run, link.invalid) == (4.0, 0.0)
    assert watch(wild._replace(refused=4.0), link, AT_SPEED, control).invalid == 1.0
    huge = watch(wild._replace(refused=1e308, sequence=3.0), link, AT_SPEED, control)
    assert (huge.invalid_run, huge.implausible) == (1e9, 2.0)


def test_one_that_stays_in_force_is_invalid_when_the_one_before_would_be_stale(control: ControlSettings) -> None:
    """However old that one was already: the last plausible command counts, not the first wild one."""
    wild = REMOTE._replace(road_wheel_rad=1.0, sequence=2.0)
    for age in (0.0, 1.0, 30.0, control.stale_ticks - 1.0):
        link = watch(REMOTE._replace(age_ticks=age), NO_LINK, AT_SPEED, control)
        for ticks in range(int(age) + 1, int(control.stale_ticks) + 1):
            link = watch(wild._replace(age_ticks=ticks - age - 1.0), link, AT_SPEED, control, age)
            assert (link.implausible_ticks, link.invalid) == (ticks, 1.0 if ticks == control.stale_ticks else 0.0)
        silent = watch(wild._replace(age_ticks=control.stale_ticks), link, AT_SPEED, control)
        assert (silent.implausible_ticks, silent.state) == (0.0, LinkState.STALE), "silent is the truer word"
        lost = watch(wild._replace(speed_mps=math.nan), link, AT_SPEED, control)
        assert (lost.implausible, lost.implausible_ticks, lost.state) == (1.0, 0.0, LinkState.INVALID)


def test_after_a_silence_a_wild_one_is_invalid_at_once_and_renews_nothing(control: ControlSettings) -> None:
    wild = REMOTE._replace(road_wheel_rad=1.0)
    stale = watch(REMOTE._replace(age_ticks=control.stale_ticks), NO_LINK, AT_SPEED, control)
    for before, age in ((NO_LINK, NEVER_TICKS), (stale, control.stale_ticks), (stale, 3.0)):
        link = watch(wild._replace(sequence=2.0), before._replace(lease_ticks=9.0), AT_SPEED, control, age)
        assert (link.implausible_ticks, link.invalid) == (control.stale_ticks + 1.0, 1.0)
        assert (link.lease_ticks, link.state) == (8.0, LinkState.INVALID)
    plausible = watch(REMOTE, NO_LINK, AT_SPEED, control)
    assert plausible.lease_ticks == control.lease_ticks
    assert watch(wild._replace(sequence=2.0), plausible, AT_SPEED, control).lease_ticks == control.lease_ticks - 1.0
