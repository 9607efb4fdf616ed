"""What the simulated person decides, seen from outside: views in, intents out. No car."""

import math
import random

import pytest

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.simulated_person.behaviour import PersonBehaviour, Phase
from simconsole.drivers.simulated_person.guidance import Pace
from simconsole.drivers.simulated_person.launch import launch_throttle
from simconsole.drivers.simulated_person.view import View
from simconsole.drivers.speed_holder import hold_speed
from simconsole.profiles.person import Habits, PersonPlan, When
from simconsole.values.signals import Button, Mode

HZ = 250
STANDING = View(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 84.0, 1.0, 0.0, float(Mode.MANUAL))


class Watched:
    """A person before a world that the test makes up."""

    def __init__(self, **plan: object) -> None:
        self.person = PersonBehaviour(PersonPlan(**plan), HZ)  # type: ignore[arg-type]  # tests name what they need
        self.view = STANDING

    def live(self, seconds: float, **seen: float) -> Intent:
        for _ in range(round(seconds * HZ)):
            self.view = self.view._replace(**seen)._replace(  # type: ignore[arg-type]  # tests name floats
                time_s=self.view.time_s + 1.0 / HZ
            )
            intent = self.person.decide(self.view)
        return intent

    def rolling(self) -> None:
        """Get to third gear at 10 m/s by claiming that everything works."""
        self.live(2.0, gear=0.0)
        for gear in (1.0, 2.0, 3.0):
            self.live(4.0, gear=gear, speed_mps=3.0 * gear, engine_radps=250.0)
        self.live(1.0, engine_radps=170.0, speed_mps=10.0)
        assert self.person.phase is Phase.DRIVE
        assert self.person.intent.gear == 3.0


def test_nobody_drives_off_before_the_console_is_ready() -> None:
    watched = Watched()
    assert watched.live(5.0, mode=float(Mode.PARKED)) == Intent()
    assert watched.live(2.0, mode=float(Mode.MANUAL)).clutch == 1.0


def test_clutch_stays_down_until_the_gear_is_in() -> None:
    watched = Watched()
    intent = watched.live(10.0, gear=0.0)
    assert (intent.clutch, intent.gear, intent.throttle) == (1.0, 1.0, 0.0)
    assert watched.live(1.0, gear=1.0, engine_radps=180.0).clutch < 1.0


def test_stalled_engine_is_started_again() -> None:
    watched = Watched()
    watched.live(4.0, gear=0.0)
    watched.live(1.0, gear=1.0, engine_radps=150.0)
    assert watched.live(0.5, engine_running=0.0, engine_radps=0.0).clutch == pytest.approx(1.0)
    assert watched.person.phase is Phase.CLUTCH_DOWN
    watched.live(1.0, engine_running=1.0, engine_radps=84.0)
    assert watched.person.phase is Phase.BITE


def test_autonomy_button_is_pressed_once_and_again_only_after_a_while() -> None:
    watched = Watched(autonomy=When(distance_m=100.0))
    watched.rolling()
    presses = 0
    for _ in range(4 * HZ):
        before = watched.person.intent.pressed
        intent = watched.live(1.0 / HZ, distance_m=120.0)
        presses += intent.pressed == int(Button.AUTONOMOUS) and before == 0
    assert presses == 3
    assert watched.live(0.5, mode=float(Mode.AUTONOMOUS)).pressed == 0
    assert watched.person.phase is Phase.WATCH


def test_taking_back_turns_further_until_the_car_lets_go() -> None:
    watched = Watched(autonomy=When(time_s=0.0), take_back=When(distance_m=500.0))
    watched.rolling()
    watched.live(1.0, mode=float(Mode.AUTONOMOUS))
    still = watched.person.intent.hand_wheel_rad
    first = watched.live(0.8, distance_m=501.0).hand_wheel_rad - still
    assert first == pytest.approx(math.radians(12.0), abs=0.01)
    assert watched.live(2.0).hand_wheel_rad - still > math.radians(20.0)
    intent = watched.live(0.5, mode=float(Mode.MANUAL))
    assert watched.person.phase is Phase.BRAKE
    assert intent.brake == pytest.approx(0.3)


def test_clutch_goes_down_when_the_automatic_left_another_gear_in() -> None:
    watched = Watched(autonomy=When(time_s=0.0), take_back=When(distance_m=500.0))
    watched.rolling()
    watched.live(1.0, mode=float(Mode.AUTONOMOUS))
    watched.live(1.0, distance_m=501.0, gear=5.0)
    intent = watched.live(0.5, mode=float(Mode.MANUAL))
    assert (intent.clutch, intent.brake) == (1.0, pytest.approx(0.3))


@pytest.mark.parametrize("mode", [Mode.STOPPED, Mode.EMERGENCY_STOP])
def test_car_that_stopped_by_itself_ends_the_drive(mode: Mode) -> None:
    watched = Watched(autonomy=When(time_s=0.0))
    watched.rolling()
    watched.live(1.0, mode=float(Mode.AUTONOMOUS))
    intent = watched.live(3.0, mode=float(mode), speed_mps=0.0)
    assert watched.person.finished
    assert (intent.gear, intent.brake) == (0.0, pytest.approx(0.3))


def test_lost_console_makes_the_person_brake() -> None:
    watched = Watched()
    watched.rolling()
    intent = watched.live(1.0, mode=float(Mode.MINIMAL_RISK))
    assert (intent.throttle, intent.clutch, intent.brake) == (0.0, 1.0, pytest.approx(0.3))


def test_after_taking_back_with_way_to_go_the_person_shifts_and_drives_on() -> None:
    watched = Watched(autonomy=When(time_s=0.0), take_back=When(distance_m=500.0), stop=When(distance_m=600.0))
    watched.rolling()
    watched.live(1.0, mode=float(Mode.AUTONOMOUS), gear=4.0)
    watched.live(0.5, distance_m=501.0)
    watched.live(0.6, mode=float(Mode.MANUAL))
    intent = watched.live(2.0, gear=3.0)
    assert watched.person.phase is Phase.DRIVE
    assert (intent.gear, intent.clutch) == (3.0, 0.0)
    assert watched.live(0.5, distance_m=601.0).brake > 0.0


def test_throttle_stays_on_the_pedal() -> None:
    assert hold_speed(30.0, 0.0, 0.0, 0.004, 0.6) == (0.6, 0.0)
    assert hold_speed(0.0, 30.0, 0.4, 0.004, 0.6)[0] == 0.0
    assert launch_throttle(STANDING._replace(engine_radps=600.0), Habits()) == 0.0


class Slow:
    """A way that the test makes up: how fast, and how hard to brake."""

    def __init__(self) -> None:
        self.wanted = Pace(10.0, 0.0)

    def look(self, view: View) -> None: ...

    def begin(self, view: View, hand_wheel_rad: float) -> None: ...

    def settle(self, view: View) -> None: ...

    def steer(self, view: View) -> float:
        return 0.0

    def pace(self, view: View) -> Pace:
        return self.wanted

    def arrived(self, view: View) -> bool:
        return False


def test_for_a_stop_on_the_way_the_person_shifts_down_rolls_waits_and_drives_off_again() -> None:
    watched, way = Watched(), Slow()
    watched.person = PersonBehaviour(PersonPlan(), HZ, way)
    watched.rolling()
    way.wanted = Pace(0.0, 0.25)
    assert watched.live(0.5).brake == pytest.approx(0.25)
    watched.live(0.5, engine_radps=120.0, speed_mps=6.0)
    assert watched.live(1.0, gear=2.0).gear == 2.0
    assert watched.live(1.0, engine_radps=95.0, speed_mps=3.0).clutch == 1.0
    waiting = watched.live(3.0, speed_mps=0.0, engine_radps=84.0, gear=0.0)
    assert (watched.person.phase, waiting.gear, waiting.brake) == (Phase.ROLL, 0.0, 0.25)
    way.wanted = Pace(2.5, 0.0)
    assert watched.live(0.5).gear == 1.0
    assert watched.live(0.3, gear=1.0, engine_radps=180.0).brake == 0.0
    assert watched.person.phase is Phase.BITE


def test_who_must_brake_to_a_stop_while_the_clutch_closes_presses_it_again() -> None:
    watched, way = Watched(), Slow()
    watched.person = PersonBehaviour(PersonPlan(), HZ, way)
    watched.live(2.0, gear=0.0)
    watched.live(1.0, gear=1.0, engine_radps=180.0)
    assert watched.person.phase is Phase.BITE
    way.wanted = Pace(0.0, 0.8)
    stopped = watched.live(1.0, speed_mps=0.5, engine_radps=100.0)
    assert (watched.person.phase, stopped.clutch, stopped.brake) == (Phase.ROLL, 1.0, 0.8)
    way.wanted = Pace(8.0, 0.0)
    watched.live(0.3, speed_mps=4.0, gear=0.0)
    watched.person.phase = Phase.SHIFT_CLOSE
    way.wanted = Pace(0.0, 0.8)
    stopped = watched.live(1.0, speed_mps=1.0, engine_radps=100.0)
    assert (watched.person.phase, stopped.clutch, stopped.brake) == (Phase.ROLL, 1.0, 0.8)


@pytest.mark.parametrize(("hurried", "gear"), [(False, 3.0), (True, 2.0)])
def test_who_is_in_a_hurry_lets_the_engine_work(hurried: bool, gear: float) -> None:
    watched, way = Watched(), Slow()
    watched.person = PersonBehaviour(PersonPlan(), HZ, way)
    watched.rolling()
    way.wanted = Pace(20.0, 0.0, hurried)
    assert watched.live(1.0, engine_radps=150.0).gear == gear


@pytest.mark.parametrize(
    "habits", [Habits(), Habits(foot_per_s=20.0, bite_release_per_s=2.0, throttle_max=1.0, brake=1.0)]
)
@pytest.mark.parametrize("tick_hz", [50, 250])
def test_feet_never_press_a_pedal_further_than_it_goes(habits: Habits, tick_hz: int) -> None:
    """No pedal of the simulated cockpit is clamped: nobody asks for more than all or less than nothing."""
    dice = random.Random(20261122)
    plan = PersonPlan(habits=habits, sit_s=0.1, stop=When(time_s=60.0))
    person, view, seen = PersonBehaviour(plan, tick_hz), STANDING, set()
    for tick in range(100 * tick_hz):
        if tick % 10 == 0:
            view = view._replace(
                speed_mps=dice.choice([0.0, dice.uniform(-1.0, 30.0)]),
                engine_radps=dice.uniform(0.0, 500.0),
                engine_running=float(dice.random() < 0.95),
                gear=dice.choice([person.intent.gear, 0.0]),
            )
        intent = person.decide(view._replace(time_s=tick / tick_hz))
        seen.add(person.phase)
        assert all(0.0 <= pressed <= 1.0 for pressed in (intent.throttle, intent.brake, intent.clutch)), intent
    assert {Phase.BITE, Phase.BRAKE, Phase.STAND} <= seen
