"""From a snapshot to what the driver is shown: values ready to be laid out, and the little a display must remember."""

from typing import Final, NamedTuple

from simconsole.hud.advice import advice_label
from simconsole.hud.captions import next_step, other_side
from simconsole.hud.guidance import Ahead, Guidance, ahead
from simconsole.hud.key_names import help_rows, key_label
from simconsole.hud.language import number, say
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.vehicle import CarProfile, VehicleProfile
from simconsole.profiles.view import ENGLISH, HudProfile, LanguageProfile
from simconsole.values.key_codes import Key
from simconsole.values.labels import commander_label, gear_label, is_eased, mode_label, notice_label, reason_label
from simconsole.values.layout import read
from simconsole.values.signals import FAR, NEVER_TICKS, Event, GateLimit, Mode, Notice
from simconsole.values.state_vector import LAYOUT, Snapshot
from simconsole.values.units import DEG_PER_RAD, KMH_PER_MPS, RPM_PER_RADPS
from simconsole.values.validity import is_trusted
from simconsole.world.rules.speed_advice import NO_ADVICE, Advice

STALE_S: Final = 0.5
"""Older snapshots are not shown: NO DATA."""
KMH: Final = "km/h"
MPS: Final = "m/s"
CMPS_PER_MPS: Final = 100.0
SPEED_HYSTERESIS: Final = 0.5
"""The shown integer follows only when the speed has left it by this much more than rounding (rule 11)."""
STANDING: Final = 0.1
"""Up to this number a car stands, for all to see: 0 is shown without hysteresis."""
SPEED_PERIOD_S: Final = 0.2
"""The speed's digits change at most this often (rule 11)."""
FORCES: Final = ("none", "on", "eased", "limit", "lost")
"""Signs of the wheel's motor."""
PAUSED: Final = "PAUSED"
TWO_GEARS: Final = "two gears"
NOT_NOW: Final = "not now"
CLIP_SHOWN_S: Final = 0.3
"""How long a cut-off force is shown: one tick of it could not be seen."""


class HudSettings(NamedTuple):
    """What the cluster must know of the car and of the rules it drives under."""

    rpm_max: float = 7000.0
    rpm_red: float = 6000.0
    takeover_window_s: float = 10.0
    link_stale_s: float = 0.2
    standstill_mps: float = 0.1
    hand_wheel_per_road_wheel: float = 15.0
    hand_wheel_lock_deg: float = 510.0  # to one side, of the car
    top_gear: int = 6
    manual_button: str = ""  # label of the button that asks for manual control; empty: there is none
    reset_button: str = ""
    limit_kmh: float = 0.0  # speed limit of a road without lanes of its own; 0: none, or it changes on the way
    help_rows: tuple[tuple[str, str], ...] = ()  # what each key or button does (`key_names.help_rows`)
    language: LanguageProfile = ENGLISH
    guidance: Guidance | None = None  # the route to follow; None: there is none
    is_robot: bool = False  # slow, without engine, gears, lights and a road: m/s and m, and how fast it turns


class HudMemory(NamedTuple):
    """What the display remembers from one picture to the next."""

    shown_speed: int = 0  # in km/h, of a robot in cm/s
    shown_s: float = -1e9
    motor_seen: bool = False  # the wheel has had a motor in this drive
    clipped_s: float = -1e9  # when force was last cut off
    stop_reason: float | None = None  # why the car has come to its stop: STOPPED itself only says that it stands
    route_m: float | None = None  # where along the route the vehicle was; None: beside it
    eased: bool = False  # the last picture showed that the wheel gives a share of the car's torque only


class HudView(NamedTuple):
    """One picture's content. Pedals 0 to 1; `driver_*` is the person, the others what the car does.

    Labels are in the driver's language already; what else is a text names a state, and is said where it is drawn.
    """

    settings: HudSettings = HudSettings()
    t_s: float = 0.0
    stale: bool = False
    shown_kmh: int = 0
    shown_cmps: int = 0  # speed of a robot, whose km/h are 0 or 1
    turn_dps: float = 0.0  # how fast it turns, left-positive
    limit_kmh: int = 0  # speed limit here; 0: none
    ahead: Ahead | None = None  # what comes next on the route; None: no route, or beside it
    rpm: float = 0.0
    engine_running: bool = False
    gear: str = "N"
    automatic: bool = False
    mode: float = float(Mode.PARKED)
    mode_label: str = "PARKED"
    reason_label: str = ""
    todo_label: str = ""  # what the driver does next
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
    hand_wheel_deg: float = 0.0  # left-positive, where the hand wheel stands that steers as the car does
    driver_hand_wheel_deg: float | None = None  # where the person's stands; None: not known
    remote_lateral: float = 0.0
    other_side: str = ""  # who has the part of the steering that the person does not have
    commander: str = "none"
    link_age_s: float | None = None
    wheel_validity: float = 0.0
    pedals_validity: float = 0.0
    shifter_validity: float = 0.0
    handbrake_validity: float = 0.0
    lever_label: str = ""  # what is wrong with the gear that the lever shows
    distance_m: float = 0.0
    force: str = "none"  # of the wheel's motor, of FORCES; limit: more torque is asked for than it has
    can_up: bool | None = None  # None: this drive has no CAN bus
    link: str | None = None  # how the rosbridge link stands (simconsole.values.labels); None: this drive has no bridge

    def say(self, phrase: str, **parts: str) -> str:
        """Return a phrase in the driver's language."""
        return say(self.settings.language, phrase, **parts)

    def number(self, value: float, digits: int) -> str:
        """Return a number as the driver's language writes it."""
        return number(self.settings.language, value, digits)

    @property
    def speed_text(self) -> str:
        """The speed without its unit."""
        return self.number(0.01 * self.shown_cmps, 2) if self.settings.is_robot else f"{self.shown_kmh}"

    @property
    def speed_unit(self) -> str:
        """The unit of the speed, as the driver's language has it."""
        return self.say(MPS if self.settings.is_robot else KMH)

    @property
    def turn_text(self) -> str:
        """How fast a robot turns, with its unit."""
        return f"{self.turn_dps:+.0f} °/s" if round(self.turn_dps) else "0 °/s"

    def distance_text(self, digits: int) -> str:
        """Return how far the drive has gone, in km with so many digits; of a robot in m with one."""
        if self.settings.is_robot:
            return f"{self.number(self.distance_m, 1)} m"
        return f"{self.number(0.001 * self.distance_m, digits)} km"


def shown_speed(speed_mps: float, t_s: float, memory: HudMemory, per_mps: float = KMH_PER_MPS) -> tuple[int, float]:
    """Return the whole number to show and since when it is shown: hysteresis, and at most five changes a second.

    It counts km/h, unless a metre a second is another number (`per_mps`) of what is counted.
    """
    speed = abs(speed_mps) * per_mps
    if not 0.0 <= t_s - memory.shown_s < 1e8:  # the first picture, or a drive that started anew
        return int(speed + 0.5), t_s
    steady = speed > STANDING and abs(speed - memory.shown_speed) < 0.5 + SPEED_HYSTERESIS
    if steady or t_s - memory.shown_s < SPEED_PERIOD_S:
        return memory.shown_speed, memory.shown_s
    return int(speed + 0.5), t_s


def settings_of(
    hud: HudProfile,
    control: ControlProfile,
    cockpit: CockpitProfile,
    vehicle: VehicleProfile,
    *,
    by_keyboard: bool,
    language: LanguageProfile = ENGLISH,
) -> HudSettings:
    """Return the cluster's settings; the times are the arbitration's own, so the countdown ends when it acts.

    Args:
        hud: The screen and the dial.
        control: The rules of the drive.
        cockpit: What the buttons are called.
        vehicle: Its steering and its gears.
        by_keyboard: Whether the window's keys drive.
        language: The driver's.
    """

    def button(key: Key, role: str) -> str:
        return say(language, key_label(key)) if by_keyboard else cockpit.button_label(role)

    ratio = vehicle.steering.ratio if isinstance(vehicle, CarProfile) else vehicle.steering_ratio
    lock_deg = vehicle.steering.max_road_wheel_deg if isinstance(vehicle, CarProfile) else vehicle.max_road_wheel_deg
    return HudSettings(
        rpm_max=hud.rpm_max,
        rpm_red=hud.rpm_red,
        takeover_window_s=control.minimal_risk_after_s,
        link_stale_s=control.command_stale_s,
        standstill_mps=control.standstill_speed_mps,
        hand_wheel_per_road_wheel=ratio,
        hand_wheel_lock_deg=ratio * lock_deg,
        top_gear=len(vehicle.gearbox.forward) if isinstance(vehicle, CarProfile) else 0,
        manual_button=button(Key.MANUAL, "manual"),
        reset_button=button(Key.RESET, "reset"),
        help_rows=help_rows(cockpit, by_keyboard=by_keyboard, language=language),
        language=language,
        is_robot=isinstance(vehicle, TurtlebotProfile),
    )


def force_label(snapshot: Snapshot, memory: HudMemory) -> tuple[str, bool, float]:
    """Return the sign of the wheel's motor, whether it has had one, and when its force was last cut off."""
    clipped_s = snapshot.t_s if snapshot.torque.clipped > 0.0 else memory.clipped_s
    if snapshot.sample.wheel_motor <= 0.0:
        return ("lost" if memory.motor_seen else "none"), memory.motor_seen, clipped_s
    if 0.0 <= snapshot.t_s - clipped_s < CLIP_SHOWN_S:
        return "limit", True, clipped_s
    torque = snapshot.torque
    eased = is_eased(torque.enabled, torque.car_share)
    if memory.eased and torque.enabled > 0.0:
        eased = 0.0 < torque.car_share < 1.0  # until it gives all of it again: a steady speed is no flicker
    return ("eased" if eased else "on"), True, clipped_s


def _notice_label(snapshot: Snapshot, language: LanguageProfile, advice: Advice) -> str:
    """Return what is told below the mode: a notice, else advice, else that traffic is lost, which it is for good."""
    first = say(language, notice_label(snapshot.arbitration.notice or snapshot.broken_rule))
    lost = snapshot.notice == Notice.TRAFFIC_LOST
    return first or advice_label(advice, language) or (say(language, notice_label(Notice.TRAFFIC_LOST)) if lost else "")


def view(
    snapshot: Snapshot,
    age_s: float,
    memory: HudMemory,
    settings: HudSettings,
    can_up: bool | None = None,
    link: str | None = None,
    advice: Advice = NO_ADVICE,
) -> tuple[HudView, HudMemory]:
    """Return the content of one picture.

    Args:
        snapshot: the newest tick.
        age_s: how long ago the display last saw a new tick, in s of its own clock.
        memory: what the previous picture left.
        settings: the dial's and the rules' numbers.
        can_up: whether the CAN bus is up; None without one.
        link: how the rosbridge link stands; None without a bridge.
        advice: for the next traffic light.
    """
    vehicle, command, driver, language = snapshot.vehicle, snapshot.command, snapshot.driver, settings.language
    arbitration = snapshot.arbitration
    per_mps = CMPS_PER_MPS if settings.is_robot else KMH_PER_MPS
    speed, shown_s = shown_speed(vehicle.vx_mps, snapshot.t_s, memory, per_mps)
    force, motor_seen, clipped_s = force_label(snapshot, memory)
    stop_reason = _stop_reason(arbitration.mode, arbitration.reason, memory)
    next_turn, route_m = _guided(snapshot, memory, settings.guidance)
    paused = bool(int(snapshot.events.events) & Event.PAUSE)
    shown = HudView(
        settings=settings,
        t_s=snapshot.t_s,
        stale=age_s > STALE_S and not paused,
        shown_kmh=round(abs(vehicle.vx_mps) * KMH_PER_MPS) if settings.is_robot else speed,
        shown_cmps=speed if settings.is_robot else 0,
        turn_dps=vehicle.yaw_rate_radps * DEG_PER_RAD,
        limit_kmh=_limit_kmh(snapshot, settings),
        ahead=next_turn,
        rpm=max(0.0, vehicle.engine_radps * RPM_PER_RADPS),
        engine_running=vehicle.engine_running != 0.0,
        gear=gear_label(vehicle.gear),
        automatic=command.automatic != 0.0,
        mode=arbitration.mode,
        mode_label=say(language, PAUSED if paused else mode_label(arbitration.mode)),
        reason_label=say(language, reason_label(arbitration.reason if stop_reason is None else stop_reason)),
        todo_label=next_step(
            snapshot, language, settings.standstill_mps, settings.manual_button, settings.reset_button
        ),
        refusal_label=say(language, reason_label(arbitration.refusal)) if arbitration.refusal else "",
        notice_label=_notice_label(snapshot, language, advice),
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
        hand_wheel_deg=vehicle.road_wheel_rad * settings.hand_wheel_per_road_wheel * DEG_PER_RAD,
        driver_hand_wheel_deg=driver.hand_wheel_rad * DEG_PER_RAD if is_trusted(driver.wheel_validity) else None,
        remote_lateral=arbitration.remote_lateral,
        other_side=other_side(snapshot),
        commander=commander_label(arbitration.commander),
        link_age_s=_link_age_s(snapshot),
        wheel_validity=driver.wheel_validity,
        pedals_validity=_worst(driver.throttle_validity, driver.brake_validity, driver.clutch_validity),
        shifter_validity=driver.shifter_validity,
        handbrake_validity=driver.handbrake_validity,
        lever_label=say(language, _lever_label(driver.lever_fault, command.gate_active)),
        distance_m=vehicle.distance_m,
        force=force,
        can_up=can_up,
        link=link,
    )
    return shown, HudMemory(
        shown_speed=speed,
        shown_s=shown_s,
        motor_seen=motor_seen,
        clipped_s=clipped_s,
        stop_reason=stop_reason,
        route_m=route_m,
        eased=force == "eased",
    )


def _limit_kmh(snapshot: Snapshot, settings: HudSettings) -> int:
    """Return the speed limit of the lane that the vehicle is in, or of the whole road; 0: none."""
    situation = snapshot.situation
    if situation.lane < 0.0:
        return round(settings.limit_kmh)
    return 0 if situation.speed_limit_mps >= FAR else round(situation.speed_limit_mps * KMH_PER_MPS)


def _guided(snapshot: Snapshot, memory: HudMemory, guidance: Guidance | None) -> tuple[Ahead | None, float | None]:
    """Return what comes next on the route, and where along it the vehicle is."""
    if guidance is None:
        return None, None
    vehicle = snapshot.vehicle
    return ahead(guidance, vehicle.x_m, vehicle.y_m, vehicle.yaw_rad, memory.route_m)


def _stop_reason(mode: float, reason: float, memory: HudMemory) -> float | None:
    """Return why the console has stopped the car, None in a mode in which it has not."""
    if mode == Mode.MINIMAL_RISK:
        return reason
    return memory.stop_reason if mode == Mode.STOPPED else None


def _remaining_s(snapshot: Snapshot, settings: HudSettings) -> float:
    """Return how long the person still has to take over; 0 where nobody asks."""
    if snapshot.arbitration.mode != Mode.TAKEOVER_REQUESTED:
        return 0.0
    memory = read(snapshot.vector, LAYOUT.memory)
    return max(0.0, settings.takeover_window_s - memory.mode_ticks / snapshot.tick_hz)


def _lever_label(lever_fault: float, gate_active: float) -> str:
    if lever_fault > 0.0:
        return TWO_GEARS
    return NOT_NOW if int(gate_active) & GateLimit.GEAR else ""


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
