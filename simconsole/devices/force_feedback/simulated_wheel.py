"""A simulated wheel with motor, friction and a person's arms: what force feedback acts on without hardware.

Pure. Its angle goes into the virtual device's axis and comes back through the joystick as any other wheel's does.
"""

from collections import deque
from collections.abc import Callable
from typing import Final, NamedTuple

from simconsole.devices.force_feedback.rim import Rim, turn
from simconsole.profiles.force_feedback import ForceFeedback
from simconsole.values.kernels import clip, kernel
from simconsole.values.units import RAD_PER_DEG

STEP_S: Final = 0.001
LAG_S: Final = 0.002
"""Lag of the motor itself; the delay on the way to it comes on top."""


class Arm(NamedTuple):
    """How a person holds the wheel: a spring to where the hands want it, damping, and the mass that turns along."""

    stiffness_nm_per_rad: float
    damping_nms: float
    inertia_kgm2: float
    limit_nm: float
    give_per_s: float  # rate at which the hands' angle follows the wheel; 0: they hold it


HANDS_OFF: Final = Arm(0.0, 0.0, 0.0, 0.0, 0.0)
RELAXED: Final = Arm(1.5, 0.15, 0.02, 0.8, 1.0)
"""Hands that rest on the rim: they go along, and slide where the wheel outruns them."""
FIRM: Final = Arm(15.0, 0.6, 0.03, 8.0, 0.0)
STEERING: Final = Arm(50.0, 1.6, 0.03, 12.0, 0.0)
"""Chosen: between the relaxed and the co-contracted arms of driving studies (a few to tens of N m per rad)."""


class WheelBody(NamedTuple):
    """The mechanics of the wheel."""

    inertia_kgm2: float
    damping_nms: float
    friction_nm: float
    lock_rad: float


class WheelState(NamedTuple):
    """The wheel after a step, left-positive."""

    rad: float
    radps: float
    motor_nm: float
    hands_rad: float  # where the hands want the wheel
    human_nm: float  # their torque on it


@kernel
def step_wheel(state: WheelState, asked_nm: float, arm: Arm, body: WheelBody, steps: int) -> WheelState:
    """Return the wheel after `steps` of 1 ms under a motor's torque and a person's arm.

    Args:
        state: Before.
        asked_nm: What the motor is asked for by now.
        arm: How it is held; the place of the hands is in `state`.
        body: Inertia, friction, lock.
        steps: How many.
    """
    rad, radps, motor_nm, hands_rad, human_nm = state.rad, state.radps, state.motor_nm, state.hands_rad, state.human_nm
    for _ in range(steps):
        motor_nm += (asked_nm - motor_nm) * (STEP_S / (STEP_S + LAG_S))
        hands_rad += (rad - hands_rad) * (arm.give_per_s * STEP_S)
        spring = arm.stiffness_nm_per_rad * (hands_rad - rad) - arm.damping_nms * radps
        pull_nm = clip(spring, -arm.limit_nm, arm.limit_nm)
        inertia = body.inertia_kgm2 + arm.inertia_kgm2
        moved = turn(Rim(rad, radps), motor_nm + pull_nm, inertia, body.damping_nms, body.friction_nm, STEP_S)
        human_nm = pull_nm - arm.inertia_kgm2 * (moved.radps - radps) / STEP_S
        rad, radps = moved.rad, moved.radps
        if abs(rad) > body.lock_rad:
            rad, radps = clip(rad, -body.lock_rad, body.lock_rad), 0.0
    return WheelState(rad, radps, motor_nm, hands_rad, human_nm)


Step = Callable[[WheelState, float, Arm, WheelBody, int], WheelState]


class SimulatedWheel:
    """One wheel. `write` and `run` are its motor's effect, `turn` lets a tick pass."""

    def __init__(self, force: ForceFeedback, lock_to_lock_deg: float, *, tick_hz: int, step: Step = step_wheel) -> None:
        """Begin at rest, straight ahead.

        Args:
            force: The profile of the wheel that it plays.
            lock_to_lock_deg: Of that wheel.
            tick_hz: Ticks per second; divides 1000.
            step: `step_wheel`, or its compiled twin.
        """
        motor = force.motor
        self._force = force
        self._body = WheelBody(
            motor.inertia_kgm2, motor.damping_nms, motor.friction_nm, 0.5 * lock_to_lock_deg * RAD_PER_DEG
        )
        self._steps = 1000 // tick_hz
        self._step = step
        self._wire = deque([0.0] * round(motor.delay_s / STEP_S))
        self._tick_hz = tick_hz
        self._torque_nm = 0.0
        self._ticks_left = 0
        self.state = WheelState(0.0, 0.0, 0.0, 0.0, 0.0)

    def write(self, level: float) -> None:
        """Set the level of the effect, a share of the motor's torque: saturated, in whole steps of the device."""
        steps = self._force.motor.level_steps
        side = 1.0 if self._force.level_pushes == "left" else -1.0
        whole = round(min(1.0, max(-1.0, level)) * steps)
        self._torque_nm = side * whole / steps * self._force.max_torque_nm

    def run(self, length_s: float) -> None:
        """Let the effect act from now for so long; 0 ends it."""
        self._ticks_left = round(length_s * self._tick_hz)

    def turn(self, arm: Arm, hands_rad: float | None = None) -> float:
        """Let one tick pass and return the angle in rad.

        Args:
            arm: How the person holds the wheel.
            hands_rad: Where they want it; None: where their hands are.
        """
        self._wire.extend([self._torque_nm if self._ticks_left > 0 else 0.0] * self._steps)
        self._ticks_left = max(0, self._ticks_left - 1)
        state = self.state
        if hands_rad is not None:
            state = state._replace(hands_rad=hands_rad)
        elif arm == HANDS_OFF:
            state = state._replace(hands_rad=state.rad)
        left = self._steps
        while left:
            arrived_nm, steps = self._wire.popleft(), 1
            while steps < left and self._wire[0] == arrived_nm:
                self._wire.popleft()
                steps += 1
            state, left = self._step(state, arrived_nm, arm, self._body, steps), left - steps
        self.state = state
        return state.rad
