"""The D cases of the fault catalogue, in whole drives: what the console makes of a cockpit that fails.

Times are simulated and count from the first tick that carries the fault to the changed output of the gate. Force
feedback (D11 to D13) has a file of its own.
"""

import math
from dataclasses import dataclass
from time import thread_time
from typing import Final, get_args

import numpy as np
import pytest
from msgspec.structs import replace
from numpy.typing import NDArray

from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.devices.synthetic.trace_format import COLUMNS, read_rows, row_text
from simconsole.hud.banner import ALERT_LABELS, alert_of
from simconsole.hud.view import HudMemory, HudSettings, view
from simconsole.profiles.device import CockpitProfile, DeviceKey
from simconsole.profiles.faults import AxisName, Fault, Freeze, Invalid, Stuck, TwoGears, Unplug
from simconsole.profiles.files.loader import load, parse
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.values.errors import ProfileError
from simconsole.values.signals import NO_SAMPLE, GateLimit, Mode, Reason, Validity
from simconsole.values.state_vector import Snapshot
from tests.evaluation.in_memory import drive_scenario
from tests.samples import Measured

TICK_HZ: Final = 250
FAULT_S: Final = 5.0
FAULT: Final = round(FAULT_S * TICK_HZ)
STALE_TICKS: Final = 25  # 100 ms

BY_HAND = """
  - {time_s: 0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.5, gear: 1, throttle: 0}
  - {time_s: 1.0, throttle: 0.4}
"""
HANDED_OVER = """
  - {time_s: 0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 1.5, press: [autonomous]}
"""
CONTROLLER = "[{start_s: 0.5, end_s: 100, kind: speed, speed_mps: 8}]"


@dataclass(frozen=True)
class Driven:
    """The rows of a drive by column."""

    vectors: NDArray[np.float64]
    columns: tuple[str, ...]

    def __getitem__(self, name: str) -> NDArray[np.float64]:
        """One column; element n is tick n + 1."""
        return self.vectors[:, self.columns.index(name)]

    def at(self, name: str, tick: int) -> float:
        return float(self[name][tick - 1])

    def mode(self, tick: int) -> Mode:
        return Mode(int(self.at("arbitration.mode", tick)))

    def first(self, mode: Mode) -> int:
        """Tick in which a mode was entered first."""
        ticks = np.flatnonzero(self["arbitration.mode"] == float(mode))
        assert len(ticks), f"never {mode.name}"
        return int(ticks[0]) + 1


def drive(
    *faults: Fault, script: str = BY_HAND, remote: str = "[]", events: str = "[]", seconds: float = 20.0
) -> Driven:
    """Drive in simulated time; whatever happens, what leaves the gate and the vehicle are numbers."""
    profile = parse(
        f"schema: 1\ntitle: d\nduration_s: {seconds}\nsession:\n  schema: 1\n  devices: {{driver: none}}\n"
        f"  features: {{control: {{manual_automatic: true}}}}\nremote: {remote}\nevents: {events}\n"
        f"script:\n  points:{script}",
        ScenarioProfile,
        "d.yaml",
    )
    scenario = replace(profile.session.scenario, faults=faults)
    recorder, columns = drive_scenario(replace(profile, session=replace(profile.session, scenario=scenario)))
    driven = Driven(recorder.vectors, columns)
    for name in ("command.throttle", "command.brake", "command.road_wheel_rad", "command.gear", "vehicle.vx_mps"):
        assert np.isfinite(driven[name]).all()
    return driven


def alert(driven: Driven, tick: int) -> str:
    """The headline on the driver's screen."""
    snapshot = Snapshot(tick, TICK_HZ, driven.vectors[tick - 1])
    return ALERT_LABELS[alert_of(view(snapshot, 0.0, HudMemory(), HudSettings())[0])][0]


def test_d00_without_a_fault_both_drive_on() -> None:
    assert drive().mode(5000) is Mode.MANUAL
    assert drive(script=HANDED_OVER, remote=CONTROLLER).mode(5000) is Mode.AUTONOMOUS


@pytest.mark.fault("D01")
def test_d01_wheel_unplugged_by_hand_stops_the_car() -> None:
    """Seen within 50 ms; a stop without the person, to standstill; the driver is told and the reason recorded."""
    driven = drive(Unplug(device="wheel", at_s=FAULT_S))
    assert driven.mode(FAULT - 1) is Mode.MANUAL
    seen = driven.first(Mode.MINIMAL_RISK)
    assert (seen - FAULT) / TICK_HZ <= 0.05
    assert driven.at("arbitration.reason", seen) == Reason.DEVICE_LOST
    assert driven.at("command.throttle", seen) == 0.0 or driven.at("command.throttle", seen + 25) == 0.0
    assert alert(driven, seen) == "CAR IS STOPPING"
    assert driven.at("driver.wheel_validity", seen) == Validity.LOST
    stopped = driven.first(Mode.STOPPED)
    assert abs(driven["vehicle.vx_mps"][stopped:]).max() < 0.1
    assert set(driven["arbitration.mode"][stopped:]) == {Mode.STOPPED}
    assert driven["vehicle.ax_mps2"][FAULT:].min() > -4.5, "a stop, no crash stop"


@pytest.mark.fault("D01")
def test_d01_half_of_a_pedal_never_comes_through() -> None:
    """All axes read 0.0 as SDL leaves them: half throttle and half brake on this cockpit."""
    driven = drive(Unplug(device="wheel", at_s=FAULT_S))
    assert set(driven["driver.throttle"][FAULT - 1 :]) == {0.0}
    assert set(driven["driver.brake"][FAULT - 1 :]) == {0.0}


@pytest.mark.fault("D02")
def test_d02_wheel_unplugged_in_autonomy_asks_and_stops_after_ten_seconds() -> None:
    driven = drive(Unplug(device="wheel", at_s=FAULT_S), script=HANDED_OVER, remote=CONTROLLER)
    assert driven.mode(FAULT - 1) is Mode.AUTONOMOUS
    asked = driven.first(Mode.TAKEOVER_REQUESTED)
    assert (asked - FAULT) / TICK_HZ <= 0.05
    assert driven.at("arbitration.reason", asked) == Reason.DEVICE_LOST
    assert alert(driven, asked) == "TAKE OVER"
    gave_up = driven.first(Mode.MINIMAL_RISK)
    assert (gave_up - asked) / TICK_HZ == pytest.approx(10.0, abs=0.01)
    assert driven.at("vehicle.vx_mps", gave_up - 1) > driven.at("vehicle.vx_mps", asked) + 3.0, "autonomy goes on"
    assert driven.mode(5000) in (Mode.MINIMAL_RISK, Mode.STOPPED)


@pytest.mark.fault("D02")
def test_d02_wheel_plugged_in_again_in_time_stops_nothing_and_engages_nothing() -> None:
    """Back where the car steers, pedals at rest: the request stands until the person acts, without an end."""
    unplug = Unplug(device="wheel", at_s=FAULT_S, for_s=8.0)
    driven = drive(unplug, script=HANDED_OVER, remote=CONTROLLER)
    back = FAULT + round(8.0 * TICK_HZ)
    assert driven.mode(back - 1) is Mode.TAKEOVER_REQUESTED
    assert set(driven["arbitration.mode"][back:]) == {Mode.TAKEOVER_REQUESTED}
    assert driven.at("driver.wheel_validity", 5000) == Validity.LIVE
    assert driven.at("vehicle.vx_mps", 5000) > 7.0


@pytest.mark.fault("D02")
def test_d02_request_of_the_controller_is_not_withdrawn_by_a_wheel_that_is_back() -> None:
    """Asked for while the wheel is gone: it stands, and nobody reacts."""
    events = "[{at_s: 6.0, event: request_takeover}]"
    unplug = Unplug(device="wheel", at_s=FAULT_S, for_s=3.0)
    driven = drive(unplug, script=HANDED_OVER, remote=CONTROLLER, events=events)
    gave_up = driven.first(Mode.MINIMAL_RISK)
    assert (gave_up - FAULT) / TICK_HZ == pytest.approx(10.0, abs=0.01)
    assert driven.at("arbitration.reason", gave_up) == Reason.NO_REACTION


@pytest.mark.fault("D03")
@pytest.mark.parametrize("device", ["wheel", "pedals"])
def test_d03_silent_device_is_stale_after_100_ms(device: str) -> None:
    driven = drive(Freeze(device=device, at_s=FAULT_S))  # type: ignore[arg-type]  # a literal
    left = driven.first(Mode.MINIMAL_RISK)
    assert left - FAULT == STALE_TICKS, "held until then, and left in the tick in which it is stale"
    assert driven.at("driver.throttle", left - 1) == driven.at("driver.throttle", FAULT - 1)
    assert driven.at("driver.throttle_validity", left) == Validity.STALE
    driven.first(Mode.STOPPED)


@pytest.mark.fault("D03")
def test_d03_wheel_that_does_not_move_for_a_minute_is_no_fault() -> None:
    axes = [Stuck(axis=axis, at_s=2.0) for axis in get_args(AxisName)]
    driven = drive(*axes, seconds=64.0)
    assert np.ptp(driven["sample.wheel_axis"][500:]) == np.ptp(driven["sample.throttle_axis"][500:]) == 0.0
    assert set(driven["arbitration.mode"][500:]) == {Mode.MANUAL}


LEFT_DEG: Final = 30.0
REPLUGGED: Final = 6.0
"""Back while the car still rolls, its road wheels nearly where the person had them."""


@pytest.mark.fault("D04")
def test_d04_control_returns_when_pedals_are_released_and_the_wheel_stands_as_the_car_steers() -> None:
    """Unplugged in a bend and back a second later: the wheel elsewhere, the foot on the throttle; then one by one."""
    script = """
  - {time_s: 0, throttle: 0, brake: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 0.5, gear: 1, throttle: 0}
  - {time_s: 1.0, throttle: 0.4, hand_wheel_deg: 0}
  - {time_s: 4.0, hand_wheel_deg: 30, throttle: 0.4}
  - {time_s: 5.1, hand_wheel_deg: 30}
  - {time_s: 5.2, hand_wheel_deg: -30}
  - {time_s: 8.0, throttle: 0.4, hand_wheel_deg: -30}
  - {time_s: 8.1, throttle: 0, press: [manual]}
  - {time_s: 9.0, hand_wheel_deg: -30}
  - {time_s: 12.0, hand_wheel_deg: 30, press: [manual]}
  - {time_s: 20.0, hand_wheel_deg: 30}
"""
    driven = drive(Unplug(device="wheel", at_s=FAULT_S, for_s=1.0), script=script)
    model_deg = np.degrees(driven["vehicle.road_wheel_rad"]) * steering_ratio(driven)
    wheel_deg = np.degrees(-driven["sample.wheel_axis"] * math.radians(540.0))
    back = round(REPLUGGED * TICK_HZ)
    validity = driven["driver.wheel_validity"]
    armed = int(np.flatnonzero(validity[back:] == Validity.ARMED)[0]) + back
    assert set(validity[FAULT:armed]) == {Validity.LOST}
    assert armed > 9.0 * TICK_HZ, "-30 degrees are too far from where the car steers"
    assert abs(wheel_deg[armed] - model_deg[armed - 1]) <= 5.0
    assert abs(wheel_deg[armed - 1] - model_deg[armed - 2]) > 5.0
    throttle = driven["driver.throttle_validity"]
    assert set(throttle[back:2000]) == {Validity.UNKNOWN}, "the foot is still down"
    by_hand = np.flatnonzero(driven["arbitration.mode"][FAULT:] == Mode.MANUAL) + FAULT
    assert by_hand[0] + 1 == 12.0 * TICK_HZ, "asked for too early it was refused; nobody engages it but the person"
    steps = np.abs(np.diff(driven["command.road_wheel_rad"]))
    assert math.degrees(steps[FAULT:].max()) < 0.5, "and the road wheels never jump"


def steering_ratio(driven: Driven) -> float:
    """Hand wheel per road wheel, from the drive before the fault."""
    at = FAULT - 2
    return float(driven["driver.hand_wheel_rad"][at] / driven["command.road_wheel_rad"][at])


@pytest.mark.fault("D05")
def test_d05_throttle_stuck_at_the_start_keeps_the_car_parked() -> None:
    released_s = 3.0
    driven = drive(Stuck(axis="throttle", raw=-1.0, at_s=0.0, for_s=released_s), seconds=6.0, script=STANDING)
    assert set(driven["arbitration.mode"][: round(released_s * TICK_HZ) - 1]) == {Mode.PARKED}
    assert set(driven["driver.throttle"]) == {0.0}
    assert driven.first(Mode.MANUAL) <= round(released_s * TICK_HZ) + 1


STANDING: Final = """
  - {time_s: 0, throttle: 0, brake: 0, clutch: 0, hand_wheel_deg: 0, gear: 0}
  - {time_s: 1, gear: 1}
"""


@pytest.mark.fault("D06")
def test_d06_of_both_pedals_the_brake_wins() -> None:
    script = BY_HAND + "  - {time_s: 5.0, throttle: 0.4, brake: 0}\n  - {time_s: 5.1, throttle: 0.4, brake: 0.3}\n"
    driven = drive(script=script, seconds=6.0)
    both = (driven["driver.throttle"] > 0.2) & (driven["driver.brake"] > 0.2)
    assert both.sum() / TICK_HZ > 0.5
    first = int(np.flatnonzero(both)[0])
    assert set(driven["command.throttle"][first + round(0.04 * TICK_HZ) :]) == {0.0}, "a released stroke takes 40 ms"
    assert driven["command.brake"][first:].min() > 0.2


@pytest.mark.fault("D07")
@pytest.mark.parametrize("reading", ["not_a_number", "infinite", "minus_infinite", "huge"])
@pytest.mark.parametrize("axis", ["wheel", "throttle", "brake"])
def test_d07_reading_that_is_none_is_held_for_100_ms_and_then_lost(axis: str, reading: str) -> None:
    invalid = Invalid(axis=axis, reading=reading, at_s=FAULT_S)  # type: ignore[arg-type]  # literals
    driven = drive(invalid, seconds=7.0)
    left = driven.first(Mode.MINIMAL_RISK)
    assert left - FAULT == STALE_TICKS
    assert driven.at("driver.refused_ticks", FAULT) == 1.0
    for name in ("driver.hand_wheel_rad", "driver.throttle", "driver.brake"):
        assert len(set(driven[name][FAULT - 2 : left - 1])) == 1, "the last good one"


@pytest.mark.fault("D07")
def test_d07_reading_that_is_none_for_less_than_that_changes_nothing() -> None:
    driven = drive(Invalid(axis="wheel", at_s=FAULT_S, for_s=0.096), seconds=7.0)
    quiet = drive(seconds=7.0)
    assert set(driven["arbitration.mode"][FAULT:]) == {Mode.MANUAL}
    assert (driven["command.road_wheel_rad"] == quiet["command.road_wheel_rad"]).all()


@pytest.mark.fault("D07")
@pytest.mark.parametrize("cell", ["True", "left", "", "nan", "inf", "1.5"])
def test_d07_what_is_no_axis_in_a_trace_is_refused_with_its_line(cell: str) -> None:
    cells = row_text(1, NO_SAMPLE).rstrip().split(",")
    cells[COLUMNS.index("wheel_axis")] = cell
    with pytest.raises(ProfileError, match=r"^trace: line 3: "):
        list(read_rows([",".join(cells)], "trace"))
    width = len(COLUMNS)
    with pytest.raises(ProfileError, match=rf"^trace: line 3: value {width - 1} cells: {width} cells"):
        list(read_rows([",".join(cells[:-1])], "trace"))


@pytest.mark.fault("D08")
def test_d08_two_gears_at_once_keep_the_one_before_and_warn() -> None:
    driven = drive(TwoGears(gear=3, at_s=FAULT_S, for_s=2.0), seconds=8.0)
    during = slice(FAULT - 1, FAULT - 1 + 2 * TICK_HZ)
    assert set(driven["driver.gear"][during]) == {1.0}
    assert set(driven["driver.lever_fault"][during]) == {1.0}
    assert driven["driver.lever_fault"].sum() == 2 * TICK_HZ
    assert set(driven["command.gear"][FAULT:]) == {1.0}


@pytest.mark.fault("D08")
def test_d08_reverse_at_speed_is_not_taken_and_warned_of() -> None:
    script = BY_HAND + "  - {time_s: 5.0, gear: 1, throttle: 0.4}\n  - {time_s: 5.004, gear: -1, throttle: 0.4}\n"
    driven = drive(script=script, seconds=7.0)
    shown = driven["driver.gear"] == -1.0
    assert shown.any()
    assert driven["vehicle.vx_mps"][shown].min() > 2.0
    assert set(driven["command.gear"][shown]) == {1.0}
    assert (driven["command.gate_active"][shown].astype(int) & GateLimit.GEAR).all()


@pytest.mark.fault("D10")
@pytest.mark.parametrize("events", [100, 1000])
def test_d10_burst_of_100_000_events_leaves_the_newest_value_and_no_queue(events: int, measured: Measured) -> None:
    """Through SDL, 10^5 events in polls of 100 or 1,000 each. Motion is not queued; the newest value is read."""
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    plugged = VirtualCockpit(cockpit)
    source = SdlSource(cockpit)
    pygame = source._pygame
    polls = 100_000 // events
    took_s: list[float] = []
    try:
        device = plugged._devices[DeviceKey(0x044F, 0xB65E)]
        for tick in range(1, polls + 1):
            for event in range(events // 2):
                device.set_axis(0, (event % 200 - 100) / 100.0)
                device.set_axis(2, 1.0 - event % 7 / 10.0)
            newest = tick % 200 / 100.0 - 1.0
            device.set_axis(0, newest)
            began_s = thread_time()
            sample = source.poll(tick)
            took_s.append(thread_time() - began_s)
            assert sample.wheel_axis == pytest.approx(newest, abs=1e-4)
            assert pygame.event.peek() is False
    finally:
        source.close()
        plugged.close()
    overruns = sum(took > 1.0 / TICK_HZ for took in took_s)
    seen = f"{overruns} of {polls}; median {1e6 * sorted(took_s)[polls // 2]:.0f} us of CPU time"
    measured("D10", f"polls longer than a tick, {events} events in each", seen, "0.1 % of them")
    assert overruns <= 0.001 * polls
