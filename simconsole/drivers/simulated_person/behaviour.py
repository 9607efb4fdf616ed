"""What the simulated person decides, tick by tick: from what they see to what hands and feet do. Pure."""

import math
from collections.abc import Callable
from enum import Enum, auto
from typing import Final, NamedTuple

from simconsole.devices.calibration.inverse_calibration import Intent
from simconsole.drivers.simulated_person.guidance import Guidance, StraightOn
from simconsole.drivers.simulated_person.launch import clutch_through_bite, launch_throttle
from simconsole.drivers.simulated_person.view import View
from simconsole.drivers.speed_holder import hold_speed
from simconsole.profiles.person import PersonPlan, When
from simconsole.values.signals import Button, Mode
from simconsole.values.units import RAD_PER_DEG, RPM_PER_RADPS

PRESS_S: Final = 0.2
PRESS_AGAIN_S: Final = 1.5
ANSWER_S: Final = 0.5
"""How long the person waits for the console's answer to the button before they turn to something else."""
GATE_S: Final = 0.15
"""How long the lever takes through neutral: longer than a bouncing contact, and what a hand needs (80 to 120 ms)."""
MESH_S: Final = 2.0
ROLLING_MPS: Final = 2.5
"""Fast enough for the first gear to turn the engine above idling: the clutch may come up for good."""
STANDING_MPS: Final = 0.05
STAND_S: Final = 0.5
HOLD_BRAKE: Final = 0.3
LABOURING_RPM: Final = 950.0
"""Slower than this an engine labours in the lowest gear that fits: the clutch goes down."""
SECOND_MPS: Final = 3.5
"""Faster than this a car drives on in second gear."""
SECOND: Final = 2.0
HURRIED_SHARE: Final = 0.5
"""Of the engine speed to shift up at: below this who wants to be faster shifts down."""
GO_MPS: Final = 0.3
HALF_UP: Final = 0.5
"""Where the clutch comes up with the engine still alone: from here on the other foot is on the accelerator."""
CLUTCH_BY_MPS: Final = 6.0
"""While braking, the clutch goes down at the latest here, before a middle gear labours the engine."""


class Phase(Enum):
    """What the person is busy with."""

    SIT = auto()
    CLUTCH_DOWN = auto()
    BITE = auto()
    DRIVE = auto()
    SHIFT_OPEN = auto()
    SHIFT_GATE = auto()
    SHIFT_MESH = auto()
    SHIFT_CLOSE = auto()
    ROLL = auto()
    WATCH = auto()
    TAKE_BACK = auto()
    BRAKE = auto()
    STAND = auto()
    DONE = auto()


class _PedalTarget(NamedTuple):
    """Where feet should go; they get there at their own speed."""

    throttle: float
    brake: float
    clutch: float


PEDALS_RELEASED: Final = _PedalTarget(0.0, 0.0, 0.0)


class PersonBehaviour:
    """One simulated person. `decide` once per tick; `finished` once they have stopped."""

    def __init__(self, plan: PersonPlan, tick_hz: int, guidance: Guidance | None = None) -> None:
        """Sit down.

        Args:
            plan: What to do.
            tick_hz: The session's tick rate.
            guidance: Where to and how fast; None: straight on.
        """
        self._plan = plan
        self._guidance = StraightOn(plan) if guidance is None else guidance
        self._tick_s = 1.0 / tick_hz
        self.phase = Phase.SIT
        self._since_s = 0.0
        self._intent = Intent()
        self._next_gear = 1.0
        self._integral = 0.0
        self._pressed_s = -PRESS_AGAIN_S
        self._has_driven_itself = False
        self._feet: dict[Phase, Callable[[View], _PedalTarget]] = {
            Phase.SIT: self._sit,
            Phase.CLUTCH_DOWN: self._clutch_down,
            Phase.BITE: self._bite,
            Phase.DRIVE: self._drive,
            Phase.SHIFT_OPEN: self._shift_open,
            Phase.SHIFT_GATE: self._shift_gate,
            Phase.SHIFT_MESH: self._shift_mesh,
            Phase.SHIFT_CLOSE: self._shift_close,
            Phase.ROLL: self._roll,
            Phase.WATCH: self._watch,
            Phase.TAKE_BACK: self._take_back,
            Phase.BRAKE: self._brake,
            Phase.STAND: self._stand,
            Phase.DONE: self._done,
        }

    @property
    def finished(self) -> bool:
        """Whether the plan is carried out: the car stands, lever in neutral."""
        return self.phase is Phase.DONE

    @property
    def intent(self) -> Intent:
        """Where hands and feet are now."""
        return self._intent

    @property
    def rests_hands(self) -> bool:
        """Whether the hands only lie on the wheel: somebody else steers, or nobody has to."""
        return self.phase in (Phase.SIT, Phase.WATCH, Phase.DONE)

    def carry_hands(self, hand_wheel_rad: float) -> None:
        """Set the hands to the angle to which the wheel has moved them."""
        self._intent = self._intent._replace(hand_wheel_rad=hand_wheel_rad)

    def decide(self, view: View) -> Intent:
        """Look at one tick and move hands and feet towards what the phase wants, at a person's speed."""
        self._guidance.look(view)
        target = self._feet[self.phase](view)
        self._move(target, self._wheel(view), view)
        return self._intent

    def _go(self, phase: Phase, view: View) -> None:
        self.phase = phase
        self._since_s = view.time_s

    def _in_phase_s(self, view: View) -> float:
        return view.time_s - self._since_s

    # What the feet want, and when one phase ends and the next begins.

    def _sit(self, view: View) -> _PedalTarget:
        if self._in_phase_s(view) >= self._plan.sit_s and view.mode == Mode.MANUAL:
            self._go(Phase.CLUTCH_DOWN, view)
        return PEDALS_RELEASED

    def _clutch_down(self, view: View) -> _PedalTarget:
        if self._intent.clutch >= 1.0:
            self._lever(1.0)
            if view.engine_running and view.gear == 1.0:
                self._go(Phase.BITE, view)
        return _PedalTarget(0.0, 0.0, 1.0)

    def _bite(self, view: View) -> _PedalTarget:
        if not view.engine_running:
            self._go(Phase.CLUTCH_DOWN, view)
            return _PedalTarget(0.0, 0.0, 1.0)
        if self._guidance.pace(view).brake > 0.0:
            self._go(Phase.ROLL, view)
            return self._declutched(view)
        habits, foot = self._plan.habits, self._intent.clutch
        if view.speed_mps > ROLLING_MPS:
            foot = max(0.0, foot - habits.foot_per_s * self._tick_s)
        else:
            foot = clutch_through_bite(foot, view, habits, self._tick_s)
        if foot == 0.0:
            self._go(Phase.DRIVE, view)
        return _PedalTarget(launch_throttle(view, habits), 0.0, foot)

    def _drive(self, view: View) -> _PedalTarget:
        if not view.engine_running or view.mode not in (Mode.MANUAL, Mode.AUTONOMOUS, Mode.SHARED):
            return self._give_up(view)
        plan = self._plan
        if self._may_stop(view):
            self._go(Phase.BRAKE, view)
            return PEDALS_RELEASED
        if not self._has_driven_itself and _reached(plan.autonomy, view):
            if view.mode == Mode.AUTONOMOUS:
                self._has_driven_itself = True
                self._go(Phase.WATCH, view)
                return PEDALS_RELEASED
            if view.time_s - self._pressed_s >= PRESS_AGAIN_S:
                self._pressed_s = view.time_s
        if view.time_s - self._pressed_s >= ANSWER_S:
            self._choose_gear(view)
        return self._paced(view)

    def _choose_gear(self, view: View) -> None:
        """Go on to another gear, or to rolling without one, where the engine is too fast or too slow."""
        gear, rpm = self._intent.gear, view.engine_radps * RPM_PER_RADPS
        hurried = self._guidance.pace(view).hurried
        up_rpm, down_rpm = self._plan.habits.shift_up_rpm, self._plan.road.shift_down_rpm
        if hurried:
            up_rpm, down_rpm = self._plan.road.hurried_rpm, HURRIED_SHARE * self._plan.road.hurried_rpm
        if rpm > up_rpm and gear < self._plan.top_gear:
            self._next_gear = gear + 1.0
            self._go(Phase.SHIFT_OPEN, view)
        elif rpm < LABOURING_RPM and gear <= SECOND:
            self._go(Phase.ROLL, view)
        elif rpm < down_rpm and gear > SECOND:
            self._next_gear = gear - 1.0
            self._go(Phase.SHIFT_OPEN, view)

    def _paced(self, view: View) -> _PedalTarget:
        """Hold the speed that the way asks for, in gear."""
        target_mps, brake, _ = self._guidance.pace(view)
        if brake > 0.0:
            return _PedalTarget(0.0, brake, 0.0)
        throttle, self._integral = hold_speed(
            target_mps, view.speed_mps, self._integral, self._tick_s, self._plan.habits.throttle_max
        )
        return _PedalTarget(throttle, 0.0, 0.0)

    def _declutched(self, view: View) -> _PedalTarget:
        """Brake as the way asks for, the clutch down."""
        return _PedalTarget(0.0, self._guidance.pace(view).brake, 1.0)

    def _roll(self, view: View) -> _PedalTarget:
        """Roll in neutral, to a stop or until the way is free."""
        if self._may_stop(view):
            self._go(Phase.BRAKE, view)
            return PEDALS_RELEASED
        if self._intent.clutch >= 1.0:
            self._lever(0.0)
            target_mps, brake, _ = self._guidance.pace(view)
            if brake == 0.0 and target_mps > max(view.speed_mps, 0.0) + GO_MPS:
                self._next_gear = SECOND if view.speed_mps > SECOND_MPS else 1.0
                self._go(Phase.SHIFT_GATE, view)
        return self._declutched(view)

    def _shift_open(self, view: View) -> _PedalTarget:
        if self._intent.clutch >= 1.0:
            self._lever(0.0)
            self._go(Phase.SHIFT_GATE, view)
        return self._declutched(view)

    def _shift_gate(self, view: View) -> _PedalTarget:
        if self._in_phase_s(view) >= GATE_S:
            self._lever(self._next_gear)
            self._go(Phase.SHIFT_MESH, view)
        return self._declutched(view)

    def _shift_mesh(self, view: View) -> _PedalTarget:
        if view.gear == self._intent.gear or self._in_phase_s(view) > MESH_S:
            self._go(Phase.SHIFT_CLOSE if view.speed_mps > ROLLING_MPS else Phase.BITE, view)
        return self._declutched(view)

    def _shift_close(self, view: View) -> _PedalTarget:
        if self._guidance.pace(view).brake > 0.0 and view.speed_mps < SECOND_MPS:
            self._go(Phase.ROLL, view)  # a clutch that closes while somebody brakes to a stop stalls the engine
            return self._declutched(view)
        foot = max(0.0, self._intent.clutch - 0.5 * self._plan.habits.foot_per_s * self._tick_s)
        if foot == 0.0:
            self._go(Phase.DRIVE, view)
        return (self._paced(view) if foot < HALF_UP else self._declutched(view))._replace(clutch=foot)

    def _watch(self, view: View) -> _PedalTarget:
        if view.mode in (Mode.STOPPED, Mode.EMERGENCY_STOP, Mode.PARKED):
            self._go(Phase.STAND, view)
        elif view.mode != Mode.AUTONOMOUS or _reached(self._plan.take_back, view):
            self._guidance.begin(view, self._intent.hand_wheel_rad)
            self._go(Phase.TAKE_BACK, view)
        return PEDALS_RELEASED

    def _take_back(self, view: View) -> _PedalTarget:
        if view.mode == Mode.MANUAL:
            self._guidance.settle(view)
            if self._may_stop(view):
                self._go(Phase.BRAKE, view)
            else:
                self._next_gear = float(self._plan.top_gear)
                self._go(Phase.SHIFT_OPEN, view)
        elif view.mode in (Mode.STOPPED, Mode.EMERGENCY_STOP, Mode.PARKED):
            self._go(Phase.STAND, view)
        return PEDALS_RELEASED

    def _brake(self, view: View) -> _PedalTarget:
        if abs(view.speed_mps) < STANDING_MPS:
            self._go(Phase.STAND, view)
        clutch = 1.0 if view.speed_mps < CLUTCH_BY_MPS or self._intent.clutch > 0.0 else 0.0
        if view.gear != self._intent.gear:
            clutch = 1.0  # the automatic has left another gear in: the clutch gives the lever its effect back
        return _PedalTarget(0.0, self._plan.habits.brake, clutch)

    def _stand(self, view: View) -> _PedalTarget:
        if self._intent.clutch >= 1.0:
            self._lever(0.0)
        if self._intent.gear == 0.0 and self._in_phase_s(view) >= STAND_S and abs(view.speed_mps) < STANDING_MPS:
            self._go(Phase.DONE, view)
        return _PedalTarget(0.0, HOLD_BRAKE, 1.0)

    def _done(self, view: View) -> _PedalTarget:
        return _PedalTarget(0.0, HOLD_BRAKE, 0.0)

    def _give_up(self, view: View) -> _PedalTarget:
        self._go(Phase.BRAKE, view)
        return _PedalTarget(0.0, self._plan.habits.brake, 1.0)

    def _may_stop(self, view: View) -> bool:
        """Stop after everything else in the plan; without a `stop` of its own, as soon as the person has taken back."""
        plan = self._plan
        if self._guidance.arrived(view):
            return True
        if plan.autonomy is not None and not self._has_driven_itself:
            return False
        return _reached(plan.stop, view) if plan.stop is not None else plan.autonomy is not None

    # What the hands want.

    def _wheel(self, view: View) -> float:
        if self.phase in (Phase.WATCH, Phase.DONE):
            return self._intent.hand_wheel_rad
        if self.phase is Phase.TAKE_BACK:
            firmness = max(1.0, self._in_phase_s(view))  # turns further while the car does not hand over
            return self._guidance.steer(view) + firmness * self._plan.habits.take_back_deg * RAD_PER_DEG
        if abs(view.speed_mps) < STANDING_MPS:
            return self._intent.hand_wheel_rad
        return self._guidance.steer(view)

    # Hands and feet move at their own speed.

    def _lever(self, gear: float) -> None:
        self._intent = self._intent._replace(gear=gear)

    def _move(self, feet: _PedalTarget, hand_wheel_rad: float, view: View) -> None:
        now, habits = self._intent, self._plan.habits
        foot = habits.foot_per_s * self._tick_s
        hand = habits.hand_degps * RAD_PER_DEG * self._tick_s
        pressing = 0.0 <= view.time_s - self._pressed_s < PRESS_S
        self._intent = now._replace(
            hand_wheel_rad=_towards(now.hand_wheel_rad, hand_wheel_rad, hand),
            throttle=_towards(now.throttle, feet.throttle, foot),
            brake=_towards(now.brake, feet.brake, foot),
            clutch=_towards(now.clutch, feet.clutch, foot),
            pressed=int(Button.AUTONOMOUS) if pressing else 0,
        )


def _towards(value: float, target: float, step: float) -> float:
    return target if abs(target - value) <= step else value + math.copysign(step, target - value)


def _reached(when: When | None, view: View) -> bool:
    if when is None:
        return False
    far = when.distance_m is None or view.distance_m >= when.distance_m
    late = when.time_s is None or view.time_s >= when.time_s
    return far and late
