"""The messages that the console sends, from a snapshot, and what the ECU's command means."""

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

from simconsole.values.signals import DriverInput, Event, RemoteKind, Validity, VehicleState
from simconsole.values.state_vector import Snapshot
from simconsole.values.units import RPM_PER_RADPS

REQUESTS: Final[dict[int, Event]] = {
    1: Event.REQUEST_AUTONOMOUS,
    2: Event.REQUEST_MANUAL,
    3: Event.REQUEST_SHARED,
    4: Event.REQUEST_TAKEOVER,
    5: Event.EMERGENCY_STOP,
    6: Event.RESET,
    7: Event.MARK,
}
"""ECU_COMMAND.REQUEST; 0 asks for nothing."""
WHEEL_COLUMNS: Final = ("platform.fl_radps", "platform.fr_radps", "platform.rl_radps", "platform.rr_radps")
"""Columns of a state vector that SC_WHEELS needs; vehicles without them do not send it."""
_WHEELS: Final = ("FRONT_LEFT_SPEED", "FRONT_RIGHT_SPEED", "REAR_LEFT_SPEED", "REAR_RIGHT_SPEED")
_MOST_MS: Final = 1020.0


class Link(NamedTuple):
    """How the console receives ECU_COMMAND, for SC_STATUS."""

    state: float
    age_ms: float


class MessageContext(NamedTuple):
    """The values of one tick that messages are filled with, and the link."""

    snapshot: Snapshot
    vehicle: VehicleState
    driver: DriverInput
    link: Link
    wheels: tuple[int, ...] | None


Builder = Callable[[MessageContext], Mapping[str, float]]


def steering(context: MessageContext) -> Mapping[str, float]:
    """Return SC_STEERING."""
    return {
        "WHEEL_VALIDITY": context.driver.wheel_validity,
        "HAND_WHEEL_ANGLE": context.driver.hand_wheel_rad,
        "HAND_WHEEL_RATE": context.driver.hand_wheel_radps,
        "ROAD_WHEEL_ANGLE": context.vehicle.road_wheel_rad,
    }


def pedals(context: MessageContext) -> Mapping[str, float]:
    """Return SC_PEDALS."""
    driver = context.driver
    return {
        "THROTTLE": driver.throttle,
        "BRAKE": driver.brake,
        "CLUTCH": driver.clutch,
        "HANDBRAKE": driver.handbrake,
        "THROTTLE_LIVE": float(driver.throttle_validity == Validity.LIVE),
        "BRAKE_LIVE": float(driver.brake_validity == Validity.LIVE),
    }


def actuation(context: MessageContext) -> Mapping[str, float]:
    """Return SC_ACTUATION."""
    command = context.snapshot.command
    return {
        "ROAD_WHEEL_COMMAND": command.road_wheel_rad,
        "THROTTLE_COMMAND": command.throttle,
        "BRAKE_COMMAND": command.brake,
        "GATE_LIMITS": command.gate_active,
        "TURN_INDICATORS": command.turn_indicators,
        "HAZARD_LIGHTS": command.hazard_lights,
    }


def torque(context: MessageContext) -> Mapping[str, float]:
    """Return SC_TORQUE."""
    rim = context.snapshot.torque
    return {
        "HANDS_ON": rim.hands_on,
        "MOTOR_ENABLED": rim.enabled,
        "MOTOR_TORQUE": rim.torque_nm,
        "DRIVER_TORQUE": rim.human_nm,
        "CAR_TORQUE": rim.car_nm,
    }


def motion(context: MessageContext) -> Mapping[str, float]:
    """Return SC_MOTION."""
    vehicle = context.vehicle
    return {
        "SPEED": vehicle.vx_mps,
        "YAW_RATE": vehicle.yaw_rate_radps,
        "ACCEL_X": vehicle.ax_mps2,
        "ACCEL_Y": vehicle.ay_mps2,
    }


def wheels(context: MessageContext) -> Mapping[str, float]:
    """Return SC_WHEELS."""
    assert context.wheels is not None
    return {name: float(context.snapshot.vector[at]) for name, at in zip(_WHEELS, context.wheels, strict=True)}


def powertrain(context: MessageContext) -> Mapping[str, float]:
    """Return SC_POWERTRAIN."""
    vehicle = context.vehicle
    return {
        "GEAR": vehicle.gear,
        "LEVER": context.driver.gear,
        "ENGINE_RUNNING": vehicle.engine_running,
        "AUTOMATIC": context.snapshot.command.automatic,
        "ENGINE_SPEED": vehicle.engine_radps * RPM_PER_RADPS,
        "CLUTCH_OPEN": vehicle.clutch,
    }


def status(context: MessageContext) -> Mapping[str, float]:
    """Return SC_STATUS."""
    arbitration = context.snapshot.arbitration
    return {
        "MODE": arbitration.mode,
        "REASON": arbitration.reason,
        "REFUSAL": arbitration.refusal,
        "REMOTE_LATERAL": arbitration.remote_lateral,
        "REMOTE_LONGITUDINAL": arbitration.remote_longitudinal,
        "TAKEOVER_STAGE": arbitration.takeover_stage,
        "COMMAND_STATE": context.link.state,
        "COMMAND_AGE": min(context.link.age_ms, _MOST_MS),
        "COMMANDER": arbitration.commander,
    }


BUILDERS: Final[dict[str, Builder]] = {
    "SC_STEERING": steering,
    "SC_PEDALS": pedals,
    "SC_ACTUATION": actuation,
    "SC_TORQUE": torque,
    "SC_MOTION": motion,
    "SC_WHEELS": wheels,
    "SC_POWERTRAIN": powertrain,
    "SC_STATUS": status,
}


def wheel_columns(columns: tuple[str, ...]) -> tuple[int, ...] | None:
    """Return where a state vector holds the wheels' speeds, None where the vehicle has none."""
    if not all(name in columns for name in WHEEL_COLUMNS):
        return None
    return tuple(columns.index(name) for name in WHEEL_COLUMNS)


COMMAND_KIND: Final = float(RemoteKind.ACCELERATION)
"""The kind of command that ECU_COMMAND is."""
