"""From a snapshot to what the driver is shown: values ready to be laid out, and the little a display must remember."""

from typing import Final, NamedTuple

from simconsole.profiles.control import ControlProfile
from simconsole.profiles.view import HudProfile
from simconsole.values.labels import commander_label, gear_label, mode_label, notice_label, reason_label
from simconsole.values.layout import read
from simconsole.values.signals import NEVER_TICKS, Event, GateLimit, Mode
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.values.units import KMH_PER_MPS, RPM_PER_RADPS

STALE_S: Final = 0.5
"""Older snapshots are not shown: NO DATA."""
SPEED_HYSTERESIS_KMH: Final = 0.5
"""The shown integer follows only when the speed has left it by this much more than rounding (rule 11)."""
SPEED_PERIOD_S: Final = 0.2
"""The speed's digits change at most this often (rule 11)."""
CLIP_SHOWN_S: Final = 0.3
"""How long a cut-off force is shown: one tick of it could not be seen."""


class HudSettings(NamedTuple):
    """What the cluster must know of the car and of the rules it drives under."""

    rpm_max: float = 7000.0
    rpm_red: float = 6000.0
    takeover_window_s: float = 10.0
    link_stale_s: float = 0.2


class HudMemory(NamedTuple):
    """What the display remembers from one picture to the next."""

    shown_kmh: int = 0
    shown_s: float = -1e9
    motor_seen: bool = False  # the wheel has had a motor in this drive
    clipped_s: float = -1e9  # when force was last cut off


class HudView(NamedTuple):
    """One picture's content. Pedals 0 to 1; `driver_*` is the person, the others what the car does."""

    settings: HudSettings = HudSettings()
    t_s: float = 0.0
    stale: bool = False
    shown_kmh: int = 0
    rpm: float = 0.0
    engine_running: bool = False
    gear: str = "N"
    automatic: bool = False
    mode: float = float(Mode.PARKED)
    mode_label: str = "PARKED"
    reason_label: str = ""
    refusal_label: str = ""
    notice_label: str = ""
    recording_failed: bool = False
    takeover_stage: int = 0
    remaining_s: float = 0.0
    throttle: float = 0.0
    brake: float = 0.0
    clutch: float = 0.0
    handbrake: float = 0.0
    turn_indicators: float = 0.0  # 1 left, -1 right
    hazard_lights: float = 0.0
    driver_throttle: float = 0.0
    driver_brake: float = 0.0
    driver_clutch: float = 0.0
    road_wheel_rad: float = 0.0
    remote_lateral: float = 0.0
    commander: str = "none"
    link_age_s: float | None = None
    wheel_validity: float = 0.0
    pedals_validity: float = 0.0
    shifter_validity: float = 0.0
    handbrake_validity: float = 0.0
    lever_label: str = ""  # what is wrong with the gear that the lever shows
    distance_m: float = 0.0
    force: str = "none"  # of the wheel's motor: none, on, limit (more torque is asked for than it has), lost
    can_up: bool | None = None  # None: this drive has no CAN bus
    link: str | None = None  # how the rosbridge link stands (simconsole.values.labels); None: this drive has no bridge


def shown_speed(speed_mps: float, t_s: float, memory: HudMemory) -> tuple[int, float]:
    """Return the integer km/h to show and since when it is shown: hysteresis, and at most five changes a second."""
    kmh = abs(speed_mps) * KMH_PER_MPS
    if not 0.0 <= t_s - memory.shown_s < 1e8:  # the first picture, or a drive that started anew
        return int(kmh + 0.5), t_s
    if t_s - memory.shown_s < SPEED_PERIOD_S or abs(kmh - memory.shown_kmh) < 0.5 + SPEED_HYSTERESIS_KMH:
        return memory.shown_kmh, memory.shown_s
    return int(kmh + 0.5), t_s


def settings_of(hud: HudProfile, control: ControlProfile) -> HudSettings:
    """Return the cluster's settings; the times are the arbitration's own, so the countdown ends when it acts."""
    return HudSettings(hud.rpm_max, hud.rpm_red, control.minimal_risk_after_s, control.command_stale_s)


def force_label(snapshot: Snapshot, memory: HudMemory) -> tuple[str, bool, float]:
    """Return the sign of the wheel's motor, whether it has had one, and when its force was last cut off."""
    clipped_s = snapshot.t_s if snapshot.torque.clipped > 0.0 else memory.clipped_s
    if snapshot.sample.wheel_motor <= 0.0:
        return ("lost" if memory.motor_seen else "none"), memory.motor_seen, clipped_s
    return ("limit" if 0.0 <= snapshot.t_s - clipped_s < CLIP_SHOWN_S else "on"), True, clipped_s


def view(
    snapshot: Snapshot,
    age_s: float,
    memory: HudMemory,
    settings: HudSettings,
    can_up: bool | None = None,
    link: str | None = None,
) -> tuple[HudView, HudMemory]:
    """Return the content of one picture.

    Args:
        snapshot: the newest tick.
        age_s: how long ago the display last saw a new tick, in s of its own clock.
        memory: what the previous picture left.
        settings: the dial's and the rules' numbers.
        can_up: whether the CAN bus is up; None without one.
        link: how the rosbridge link stands; None without a bridge.
    """
    vehicle, command, driver = snapshot.vehicle, snapshot.command, snapshot.driver
    arbitration = snapshot.arbitration
    kmh, shown_s = shown_speed(vehicle.vx_mps, snapshot.t_s, memory)
    force, motor_seen, clipped_s = force_label(snapshot, memory)
    paused = bool(int(snapshot.events.events) & Event.PAUSE)
    shown = HudView(
        settings=settings,
        t_s=snapshot.t_s,
        stale=age_s > STALE_S and not paused,
        shown_kmh=kmh,
        rpm=max(0.0, vehicle.engine_radps * RPM_PER_RADPS),
        engine_running=vehicle.engine_running != 0.0,
        gear=gear_label(vehicle.gear),
        automatic=command.automatic != 0.0,
        mode=arbitration.mode,
        mode_label="PAUSED" if paused else mode_label(arbitration.mode),
        reason_label=reason_label(arbitration.reason),
        refusal_label=reason_label(arbitration.refusal) if arbitration.refusal else "",
        notice_label=notice_label(arbitration.notice),
        recording_failed=snapshot.recording_failed,
        takeover_stage=int(arbitration.takeover_stage),
        remaining_s=_remaining_s(snapshot, settings),
        throttle=command.throttle,
        brake=command.brake,
        clutch=vehicle.clutch,
        handbrake=command.handbrake,
        turn_indicators=command.turn_indicators,
        hazard_lights=command.hazard_lights,
        driver_throttle=driver.throttle,
        driver_brake=driver.brake,
        driver_clutch=driver.clutch,
        road_wheel_rad=vehicle.road_wheel_rad,
        remote_lateral=arbitration.remote_lateral,
        commander=commander_label(arbitration.commander),
        link_age_s=_link_age_s(snapshot),
        wheel_validity=driver.wheel_validity,
        pedals_validity=_worst(driver.throttle_validity, driver.brake_validity, driver.clutch_validity),
        shifter_validity=driver.shifter_validity,
        handbrake_validity=driver.handbrake_validity,
        lever_label=_lever_label(driver.lever_fault, command.gate_active),
        distance_m=vehicle.distance_m,
        force=force,
        can_up=can_up,
        link=link,
    )
    return shown, HudMemory(kmh, shown_s, motor_seen, clipped_s)


def _remaining_s(snapshot: Snapshot, settings: HudSettings) -> float:
    """Return how long the person still has to take over; 0 where nobody asks."""
    if snapshot.arbitration.mode != Mode.TAKEOVER_REQUESTED:
        return 0.0
    memory = read(snapshot.vector, LAYOUT.memory)
    return max(0.0, settings.takeover_window_s - memory.mode_ticks / snapshot.tick_hz)


def _lever_label(lever_fault: float, gate_active: float) -> str:
    if lever_fault > 0.0:
        return "two gears"
    return "not now" if int(gate_active) & GateLimit.GEAR else ""


def _link_age_s(snapshot: Snapshot) -> float | None:
    """Return how old the commander's newest accepted command is, None before the first."""
    remote = snapshot.remote
    never = remote.sequence == 0.0 or remote.age_ticks >= NEVER_TICKS
    return None if never else remote.age_ticks / snapshot.tick_hz


def _worst(*validities: float) -> float:
    """Return the least trusted of several axes: lost before stale before unknown before the rest."""
    for bad in (4.0, 3.0, 0.0):
        if bad in validities:
            return bad
    return min(validities)
