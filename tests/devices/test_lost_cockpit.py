"""A cockpit that falls silent at 100 km/h in a bend and comes back: what the car does until hands and feet count."""

from itertools import pairwise
from typing import NamedTuple

import pytest

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.tick.advance import advance_vector
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, DeviceSample, Mode, Reason
from simconsole.values.state_vector import Snapshot, TickInputs, input_vector
from tests.devices.hands_off import TICK_HZ, Bend, bend, console_of

SILENT_TICKS = 60
"""0.24 s: a cockpit counts as lost after 0.1 s."""
BACK_TICKS = 125
"""`device_back_s` of 0.5 s."""
AGES = ("wheel_age_ticks", "pedals_age_ticks")


class After(NamedTuple):
    """The ticks since the cockpit is back."""

    shots: list[Snapshot]

    def brake_from_on(self, share: float) -> int:
        """Return the first tick in which the car is braked so hard."""
        return next(at for at, shot in enumerate(self.shots) if shot.command.brake >= share)


@pytest.fixture(scope="module")
def start() -> Bend:
    found = bend("hatchback", 100, 2.0)
    assert found is not None
    return found


def driven(start: Bend, silent_ticks: int, back: Intent, seconds: float = 1.0, turn_rad: float = 0.0) -> After:
    """Drive on for a fifth of a second, let wheel and pedals be silent, and come back as `back`.

    From then on hands turn the wheel by `turn_rad` within a fifth of a second.
    """
    console, session, _ = console_of("hatchback", None)
    settings = cockpit_settings(session.cockpit, TICK_HZ)
    snapshot = Snapshot(start.tick, TICK_HZ, start.vector)

    def tick(sample: DeviceSample) -> Snapshot:
        inputs = input_vector(TickInputs(sample, NO_COMMAND, NO_EVENTS))
        return Snapshot(snapshot.tick + 1, TICK_HZ, advance_vector(snapshot.vector, inputs, console))

    before = raw_sample(Intent(hand_wheel_rad=start.hand_rad, throttle=start.throttle, gear=1.0), settings)
    for _ in range(50):
        snapshot = tick(before)
    assert snapshot.arbitration.mode == Mode.MANUAL
    for age in range(1, silent_ticks + 1):
        snapshot = tick(before._replace(**dict.fromkeys(AGES, float(age))))
    shots = []
    for ticks in range(round(seconds * TICK_HZ)):
        hand_rad = back.hand_wheel_rad + turn_rad * min(1.0, ticks / 50.0)
        snapshot = tick(raw_sample(back._replace(hand_wheel_rad=hand_rad), settings))
        shots.append(snapshot)
    return After(shots)


def test_foot_on_the_brake_brakes_at_once_and_takes_over_half_a_second_later(start: Bend) -> None:
    """As hard, as early and as long as the foot of somebody whose cockpit was never lost."""
    braking = Intent(hand_wheel_rad=start.hand_rad, brake=0.8, gear=1.0)
    lost, never = driven(start, SILENT_TICKS, braking), driven(start, 0, braking)
    assert lost.brake_from_on(0.79) <= never.brake_from_on(0.79)
    for at in range(50, BACK_TICKS):
        assert lost.shots[at].vehicle.ax_mps2 <= 0.95 * never.shots[at].vehicle.ax_mps2 < -5.0
    modes = [shot.arbitration.mode for shot in lost.shots]
    assert set(modes[: BACK_TICKS - 1]) == {Mode.MINIMAL_RISK}
    assert set(modes[BACK_TICKS - 1 :]) == {Mode.MANUAL}
    assert lost.shots[-1].arbitration.reason == Reason.BRAKE_OVERRIDE


def test_until_then_the_stop_brakes_and_stays_in_its_bend_whatever_hands_and_the_other_foot_do(start: Bend) -> None:
    """An accelerator that comes back pressed and a wheel that comes back turned are nobody's wish yet."""
    odd = driven(start, SILENT_TICKS, Intent(hand_wheel_rad=start.hand_rad + 1.0, throttle=1.0, gear=1.0), 0.49)
    held_rad = odd.shots[0].command.road_wheel_rad
    for shot in odd.shots:
        assert shot.arbitration.mode == Mode.MINIMAL_RISK
        assert shot.command.throttle == 0.0
        assert shot.command.brake > 0.0
        assert abs(shot.command.road_wheel_rad - held_rad) < 0.005
    assert odd.shots[-1].vehicle.ax_mps2 < -2.0


def test_taking_over_after_that_time_is_no_jerk(start: Bend) -> None:
    """Hands that turn the wheel take the car over, and the road wheels come to them as from any other take-over."""
    shots = driven(start, SILENT_TICKS, Intent(hand_wheel_rad=start.hand_rad, gear=1.0), 1.5, turn_rad=0.3).shots
    modes = [shot.arbitration.mode for shot in shots]
    assert (modes[BACK_TICKS - 2], modes[BACK_TICKS]) == (Mode.MINIMAL_RISK, Mode.MANUAL)
    assert shots[-1].arbitration.reason == Reason.STEERING_OVERRIDE
    steered = [shot.command.road_wheel_rad for shot in shots]
    assert max(abs(after - before) for before, after in pairwise(steered)) * TICK_HZ < 0.5
