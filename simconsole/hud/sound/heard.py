"""What there is to hear at a tick, and what one must know of the car to tell."""

import math
from collections.abc import Sequence
from enum import IntEnum
from typing import Final, NamedTuple

from simconsole.values.signals import Button, Event, GearFault, Mode
from simconsole.values.state_vector import Snapshot

SLIP_SPEED_MPS: Final = 3.0
"""Below this speed tyres do not squeal; at twice it they do in full."""
SQUEAL_FROM_RAD: Final = math.radians(5.0)
SQUEAL_FULL_RAD: Final = math.radians(11.0)
"""Slip angles between which squeal grows: about the peak of a passenger tyre's side force, and well behind it."""
SQUEAL_FROM_SLIP: Final = 0.12
SQUEAL_FULL_SLIP: Final = 0.45
"""The same for slip along the wheel, as a share."""
STOPS: Final = (Mode.MINIMAL_RISK, Mode.EMERGENCY_STOP)


class Tone(IntEnum):
    """What a person is told by sound; one at a time, the most urgent."""

    NONE = 0
    ENGAGED = 1
    """The controller drives from here on."""
    RELEASED = 2
    """The person drives from here on."""
    WARNING = 3
    """A refusal, a broken rule, a notice."""
    TAKE_OVER = 4
    TAKE_OVER_NOW = 5
    STOPPING = 6
    """The console brings the car to rest."""


class SoundSettings(NamedTuple):
    """What one must know of the car. A vehicle without an engine has no cylinders."""

    cylinders: int = 4
    wheelbase_m: float = 2.6
    wheel_radius_m: float = 0.31
    wheels: tuple[int, ...] | None = None
    """Columns of the state vector with the wheels' speeds in rad/s: front left, front right, rear left, rear right."""


class OtherHeard(NamedTuple):
    """A road user, from the driver's place."""

    id: float
    bearing_rad: float  # 0 ahead, left-positive
    distance_m: float
    speed_mps: float
    closing_mps: float  # how fast it comes nearer


class Heard(NamedTuple):
    """A moment's sound: levels 0 to 1."""

    engine_radps: float = 0.0
    load: float = 0.0  # of the engine: the throttle
    speed_mps: float = 0.0
    squeal_front: float = 0.0
    squeal_rear: float = 0.0
    grind: bool = False
    indicators: bool = False
    t_s: float = 0.0  # simulated: the lamps flash by it
    horn: bool = False
    tone: Tone = Tone.NONE
    others: tuple[OtherHeard, ...] = ()


def heard(snapshot: Snapshot, settings: SoundSettings, others: Sequence[OtherHeard] = ()) -> Heard:
    """Return what there is to hear after a tick."""
    vehicle, command, driver = snapshot.vehicle, snapshot.command, snapshot.driver
    if int(snapshot.events.events) & Event.PAUSE:
        return Heard(t_s=snapshot.t_s)
    front, rear = squeal(snapshot, settings)
    return Heard(
        engine_radps=max(0.0, vehicle.engine_radps) if settings.cylinders else 0.0,
        load=command.throttle if vehicle.engine_running else 0.0,
        speed_mps=math.hypot(vehicle.vx_mps, vehicle.vy_mps),
        squeal_front=front,
        squeal_rear=rear,
        grind=bool(int(vehicle.gear_fault) & GearFault.GRIND),
        indicators=command.turn_indicators != 0.0 or command.hazard_lights != 0.0,
        t_s=snapshot.t_s,
        horn=bool(int(driver.pressed) & Button.HORN),
        tone=_condition(snapshot),
        others=tuple(others),
    )


def _condition(snapshot: Snapshot) -> Tone:
    """Return the tone of what lasts; changes of mode are the listener's (`Listener`)."""
    arbitration = snapshot.arbitration
    if arbitration.mode in STOPS:
        return Tone.STOPPING
    if arbitration.mode == Mode.TAKEOVER_REQUESTED:
        return Tone.TAKE_OVER_NOW if arbitration.takeover_stage >= 2.0 else Tone.TAKE_OVER
    return Tone.WARNING if arbitration.refusal or snapshot.notice else Tone.NONE


class Listener:
    """Hears tick after tick: what lasts, and the changes of who drives."""

    CHIME_S: Final = 0.6
    """For how long a change of who drives is told, in simulated time."""

    def __init__(self, settings: SoundSettings) -> None:
        self._settings = settings
        self._mode: float | None = None
        self._chime = Tone.NONE
        self._until_s = 0.0

    def __call__(self, snapshot: Snapshot, others: Sequence[OtherHeard] = ()) -> Heard:
        """Return what there is to hear after a tick."""
        found = heard(snapshot, self._settings, others)
        mode, t_s = snapshot.arbitration.mode, snapshot.t_s
        if self._mode is not None and mode != self._mode:
            self._chime = _CHIMES.get(mode, Tone.NONE)
            self._until_s = t_s + self.CHIME_S
        self._mode = mode
        rings = self._until_s - self.CHIME_S <= t_s < self._until_s
        return found._replace(tone=self._chime) if rings and found.tone <= Tone.WARNING else found


_CHIMES: Final[dict[float, Tone]] = {
    Mode.AUTONOMOUS: Tone.ENGAGED,
    Mode.SHARED: Tone.ENGAGED,
    Mode.MANUAL: Tone.RELEASED,
}


def squeal(snapshot: Snapshot, settings: SoundSettings) -> tuple[float, float]:
    """Return how loud the front and the rear tyres squeal, each 0 to 1."""
    vehicle = snapshot.vehicle
    speed_mps = math.hypot(vehicle.vx_mps, vehicle.vy_mps)
    moving = _grows(speed_mps, SLIP_SPEED_MPS, 2.0 * SLIP_SPEED_MPS)
    if moving == 0.0:
        return 0.0, 0.0
    ahead_mps = abs(vehicle.vx_mps)
    side_front = vehicle.vy_mps + vehicle.yaw_rate_radps * settings.wheelbase_m
    steer_rad = vehicle.road_wheel_rad if vehicle.vx_mps >= 0.0 else -vehicle.road_wheel_rad
    slip_front = abs(math.atan2(side_front, ahead_mps) - steer_rad)
    slip_rear = abs(math.atan2(vehicle.vy_mps, ahead_mps))
    along = _slip_along(snapshot, settings)
    sideways = (_grows(slip_rad, SQUEAL_FROM_RAD, SQUEAL_FULL_RAD) for slip_rad in (slip_front, slip_rear))
    front, rear = (moving * max(pair) for pair in zip(sideways, along, strict=True))
    return front, rear


def _slip_along(snapshot: Snapshot, settings: SoundSettings) -> tuple[float, float]:
    if settings.wheels is None:
        return 0.0, 0.0
    vx_mps = snapshot.vehicle.vx_mps
    rims_mps = (settings.wheel_radius_m * float(snapshot.vector[column]) for column in settings.wheels)
    slips = [abs(rim - vx_mps) / max(abs(rim), abs(vx_mps), 1.0) for rim in rims_mps]
    front, rear = (_grows(max(pair), SQUEAL_FROM_SLIP, SQUEAL_FULL_SLIP) for pair in (slips[:2], slips[2:]))
    return front, rear


def _grows(value: float, start: float, full: float) -> float:
    """Return 0 up to `start`, 1 from `full` on, and a smooth way between."""
    share = min(1.0, max(0.0, (value - start) / (full - start)))
    return share * share * (3.0 - 2.0 * share)
