"""Each fault of the devices alone: what it makes of a sample, and what it leaves as it was."""

import math
from collections.abc import Sequence

import pytest

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.faults.cockpit_faults import FaultyDevices, drawn
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.faults import (
    Burst,
    Fault,
    Freeze,
    Invalid,
    Late,
    Noise,
    Stuck,
    Swapped,
    TwoGears,
    Unplug,
)
from simconsole.profiles.files.loader import load
from simconsole.values.errors import ProfileError
from simconsole.values.signals import NEVER_TICKS, DeviceSample

TICK_HZ = 250


@pytest.fixture(scope="module")
def cockpit() -> CockpitProfile:
    return load("devices", "t500rs_th8rs", CockpitProfile)


class Ramp:
    """A source whose every value tells its tick."""

    closed = False

    def poll(self, tick: int) -> DeviceSample:
        raw = tick / 1000.0
        axes = (raw, raw + 0.1, raw + 0.2, raw + 0.3, raw + 0.4)
        return DeviceSample(*axes, 1.0, 2.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0)

    def close(self) -> None:
        self.closed = True


class Window:
    """On from tick 11 to tick 20."""

    ticks = 0

    def turn(self, tick: int) -> None:
        self.ticks = tick - 10 if 11 <= tick <= 20 else 0


def driven(cockpit: CockpitProfile, *faults: Fault) -> list[DeviceSample]:
    """Samples of ticks 0 to 30; all faults are on from 11 to 20."""
    window = Window()
    source = FaultyDevices(
        Ramp(), [(fault, window) for fault in faults], cockpit, cockpit_settings(cockpit, TICK_HZ), TICK_HZ
    )
    samples = []
    for tick in range(31):
        window.turn(tick)
        samples.append(source.poll(tick))
    return samples


def changed(samples: Sequence[DeviceSample]) -> list[int]:
    """Ticks whose sample is not the true one."""
    true = Ramp()
    return [tick for tick, sample in enumerate(samples) if repr(sample) != repr(true.poll(tick))]


@pytest.mark.parametrize(
    "fault",
    [
        Unplug(at_s=0.0, device="shifter"),
        Freeze(at_s=0.0, device="wheel"),
        Stuck(at_s=0.0, axis="brake"),
        Swapped(at_s=0.0, axis="throttle", other="brake"),
        Noise(at_s=0.0, axis="wheel", amplitude_raw=0.1),
        Late(at_s=0.0, device="wheel", by_ms=20.0),
        Invalid(at_s=0.0, axis="clutch"),
        Burst(at_s=0.0, device="pedals"),
        TwoGears(at_s=0.0, gear=-1),
    ],
    ids=lambda fault: type(fault).__name__,
)
def test_a_fault_changes_its_own_ticks_and_no_other(cockpit: CockpitProfile, fault: Fault) -> None:
    assert changed(driven(cockpit, fault)) == list(range(11, 21))


def test_pulling_the_wheel_takes_the_pedals_behind_it_along(cockpit: CockpitProfile) -> None:
    sample = driven(cockpit, Unplug(at_s=0.0, device="pedals"))[15]
    assert (sample.wheel_age_ticks, sample.pedals_age_ticks, sample.shifter_age_ticks) == (NEVER_TICKS, NEVER_TICKS, 0)
    assert sample[:5] == (0.0,) * 5, "as SDL leaves the axes of a device that is gone"
    assert (sample.wheel_buttons, sample.shifter_buttons, sample.wheel_motor) == (0.0, 2.0, 0.0)


def test_a_frozen_device_repeats_itself_and_grows_old(cockpit: CockpitProfile) -> None:
    samples = driven(cockpit, Freeze(at_s=0.0, device="wheel"))
    assert {sample[:5] for sample in samples[10:21]} == {samples[10][:5]}
    assert [sample.wheel_age_ticks for sample in samples[10:22]] == [*range(11), 0.0]
    assert [sample.shifter_age_ticks for sample in samples] == [0.0] * 31
    assert {sample.wheel_motor for sample in samples[11:21]} == {0.0}, "its motor is not heard of either"


def test_a_stuck_axis_stays_where_it_was_or_goes_where_it_is_told(cockpit: CockpitProfile) -> None:
    here = driven(cockpit, Stuck(at_s=0.0, axis="throttle"))
    there = driven(cockpit, Stuck(at_s=0.0, axis="throttle", raw=-1.0))
    assert {sample.throttle_axis for sample in here[10:21]} == {0.11}
    assert {sample.throttle_axis for sample in there[11:21]} == {-1.0}
    assert {sample.pedals_age_ticks for sample in there} == {0.0}, "nothing tells that it is stuck"


def test_swapped_axes(cockpit: CockpitProfile) -> None:
    true, sample = Ramp().poll(15), driven(cockpit, Swapped(at_s=0.0, axis="throttle", other="brake"))[15]
    assert sample == true._replace(throttle_axis=true.brake_axis, brake_axis=true.throttle_axis)


def test_noise_is_the_same_again_for_the_same_seed_and_another_for_another(cockpit: CockpitProfile) -> None:
    one, same, other = (
        driven(cockpit, Noise(at_s=0.0, axis="wheel", amplitude_raw=0.1, seed=seed)) for seed in (7, 7, 8)
    )
    assert one == same
    assert [sample.wheel_axis for sample in one] != [sample.wheel_axis for sample in other]
    offsets = [sample.wheel_axis - Ramp().poll(tick).wheel_axis for tick, sample in enumerate(one)][11:21]
    assert len(set(offsets)) == 10
    assert all(0.0 < abs(offset) <= 0.1 for offset in offsets)


def test_noise_is_spread_evenly() -> None:
    values = [drawn(3, tick, 0) for tick in range(20_000)]
    assert all(-1.0 <= value < 1.0 for value in values)
    assert abs(sum(values) / len(values)) < 0.02
    assert abs(sum(value * value for value in values) / len(values) - 1.0 / 3.0) < 0.01
    assert drawn(3, 1, 0) != drawn(3, 0, 1), "no two arguments are mixed up"


def test_noise_never_leaves_the_range_of_an_axis(cockpit: CockpitProfile) -> None:
    samples = driven(cockpit, Noise(at_s=0.0, axis="handbrake", amplitude_raw=2.0))
    assert all(-1.0 <= sample.handbrake_axis <= 1.0 for sample in samples)


@pytest.mark.parametrize(("stamped", "age"), [(True, 5.0), (False, 0.0)])
def test_late_samples_are_older_ones_and_know_it_where_they_are_stamped(
    cockpit: CockpitProfile, stamped: bool, age: float
) -> None:
    samples = driven(cockpit, Late(at_s=0.0, device="wheel", by_ms=20.0, stamped=stamped))
    true = Ramp().poll(10)
    assert samples[15][:5] == true[:5]
    assert (samples[15].wheel_age_ticks, samples[15].shifter_age_ticks) == (age, 0.0)


def test_a_device_that_is_late_from_its_first_tick_on_is_not_there_yet(cockpit: CockpitProfile) -> None:
    always = Window()
    always.ticks = 1
    late = Late(at_s=0.0, device="shifter", by_ms=20.0)
    source = FaultyDevices(Ramp(), [(late, always)], cockpit, cockpit_settings(cockpit, TICK_HZ), TICK_HZ)
    assert [source.poll(tick).shifter_age_ticks for tick in range(7)] == [NEVER_TICKS] * 5 + [5.0, 5.0]


def test_readings_that_are_no_numbers(cockpit: CockpitProfile) -> None:
    nan, inf, minus, huge = (
        driven(cockpit, Invalid(at_s=0.0, axis="wheel", reading=reading))[12].wheel_axis
        for reading in ("not_a_number", "infinite", "minus_infinite", "huge")
    )
    assert math.isnan(nan)
    assert (inf, minus, huge) == (math.inf, -math.inf, 1e308)


def test_of_a_burst_the_newest_event_of_a_tick_counts(cockpit: CockpitProfile) -> None:
    samples = driven(cockpit, Burst(at_s=0.0, device="pedals", events_per_s=100_000, amplitude_raw=0.1, seed=5))
    newest = drawn(5, 12, 1, 100_000 // TICK_HZ - 1)  # place 1: the first axis of the pedals, behind the wheel's
    assert samples[12].throttle_axis == Ramp().poll(12).throttle_axis + 0.1 * newest


def test_two_gears(cockpit: CockpitProfile) -> None:
    assert driven(cockpit, TwoGears(at_s=0.0, gear=-1))[12].shifter_buttons == float(1 << 7 | 2)
    assert driven(cockpit, TwoGears(at_s=0.0, gear=3))[12].shifter_buttons == float(1 << 2 | 2)


def test_a_gear_that_the_cockpit_has_not_is_refused(cockpit: CockpitProfile) -> None:
    keyboard = load("devices", "keyboard", CockpitProfile)
    with pytest.raises(ProfileError, match=r"faults: gear: value 3: a gear that the H pattern of the shifter has"):
        driven(keyboard, TwoGears(at_s=0.0, gear=3))


def test_faults_act_one_after_the_other(cockpit: CockpitProfile) -> None:
    samples = driven(
        cockpit,
        Stuck(at_s=0.0, axis="throttle", raw=0.5),
        Swapped(at_s=0.0, axis="throttle", other="brake"),
    )
    assert samples[15].brake_axis == 0.5


def test_the_devices_are_closed_through_the_faults(cockpit: CockpitProfile) -> None:
    source = Ramp()
    FaultyDevices(source, [], cockpit, cockpit_settings(cockpit, TICK_HZ), TICK_HZ).close()
    assert source.closed
