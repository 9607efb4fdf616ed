"""The main job, end to end: a person at the wheel, an autopilot over rosbridge, a bundle that tells all of it."""

import json
from collections.abc import Callable
from itertools import pairwise

import msgspec
import numpy as np
import pytest

from simconsole.cli.demo import demo_session
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.link import link_label
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.reading import LogTable
from simconsole.recording.recorded_road_users import recorded_road_users
from simconsole.values.signals import FAR, Button, Event, Mode, Reason, Validity
from simconsole.values.units import RAD_PER_DEG
from tests.drives.console import simconsole
from tests.drives.fixtures import Demo

PEDALS = ("throttle", "brake", "clutch")
PARTS = ("wheel", *PEDALS, "shifter")
RULES = ("collision", "red_light", "off_road", "wrong_way", "speeding", "failing_to_yield")
COLUMNS = (
    *("arbitration.mode", "arbitration.reason", "events.events", "memory.engage_hand_wheel_rad"),
    *("driver.edges", "driver.hand_wheel_rad", "motor.explained_rad", "torque.enabled", "torque.torque_nm"),
    *("ros.age_ticks", "ros.refused", "sample.shifter_buttons", "sample.wheel_axis"),
    *("situation.signal_distance_m", "situation.yield_m", "vehicle.ay_mps2", "vehicle.engine_running"),
    *("vehicle.gear", "vehicle.road_wheel_rad", "vehicle.vx_mps"),
    *(f"driver.{part}_validity" for part in PARTS),
    *(f"driver.{pedal}" for pedal in PEDALS),
    *(f"sample.{pedal}_axis" for pedal in PEDALS),
    *(f"rules.{rule}" for rule in RULES),
)


@pytest.fixture(scope="module")
def table(demo: Demo) -> LogTable:
    return demo.table(*COLUMNS)


def test_it_writes_a_whole_bundle_with_report_and_scene(demo: Demo) -> None:
    done = simconsole("verify", demo.bundle)  # 170 MB, which no process of the tests should hold
    assert done.returncode == 0, done.stdout + done.stderr
    assert demo.results["bundle"] == str(demo.bundle)
    assert open_bundle(demo.bundle).manifest.digest == demo.results["digest"]
    report = (demo.bundle / "report.html").read_text("utf-8")
    assert "First drive" in report
    assert "<svg" in report
    assert (demo.bundle / "scene.rrd").stat().st_size > 100_000
    for name in ("bundle", "report", "scene"):
        assert any(line.split()[0] == name for line in demo.done.stderr.splitlines()), name


def test_on_a_pipe_it_shows_no_progress_and_ends_with_its_results(demo: Demo) -> None:
    assert json.loads(demo.done.stdout)["ticks"] == demo.ticks
    assert "\r" not in demo.done.stderr
    assert "\x1b" not in demo.done.stderr
    lines = demo.done.stderr.splitlines()
    assert all(line.startswith("  ") for line in lines), "nothing but the table"
    named = {line.split("  ")[1].strip() for line in lines}
    assert {"distance", "duration", "lateral error", "tick lateness", "real-time factor"} <= named


def test_the_mode_goes_from_person_to_autopilot_and_back(demo: Demo, table: LogTable) -> None:
    changes = demo.results["mode_changes"]
    assert [(change["mode"], change["reason"]) for change in changes] == [
        ("MANUAL", "controls ready"),
        ("AUTONOMOUS", "driver asked"),
        ("MANUAL", "driver turned the wheel"),
    ]
    modes = table.column("arbitration.mode")
    reasons = table.column("arbitration.reason")
    assert [(float(Mode.MANUAL), float(Reason.ARMED)), (float(Mode.AUTONOMOUS), float(Reason.PERSON_ASKED))] == [
        (modes[change["tick"] - 1], reasons[change["tick"] - 1]) for change in changes[:2]
    ]
    assert reasons[-1] == Reason.STEERING_OVERRIDE
    assert not table.column("events.events").any(), "nobody but the person changed the mode, no answer was missed"


def test_the_person_asks_by_a_button_and_takes_back_by_the_wheel(demo: Demo, table: LogTable) -> None:
    _, engaged, taken = (change["tick"] - 1 for change in demo.results["mode_changes"])
    edges = table.column("driver.edges").astype(int)
    pressed = np.flatnonzero(edges & int(Button.AUTONOMOUS))
    assert len(pressed) > 0
    assert pressed[-1] <= engaged < pressed[-1] + 250
    wheel = table.column("driver.hand_wheel_rad")
    brake = table.column("driver.brake")
    own = wheel - table.column("motor.explained_rad") - table.column("memory.engage_hand_wheel_rad")
    assert np.abs(own[engaged + 1 : taken - 100]).max() < 8.0 * RAD_PER_DEG, "what the motor does is not the person's"
    assert np.abs(own[taken - 25 : taken]).max() > 4.0 * RAD_PER_DEG
    assert brake[engaged : taken + 1].max() == 0.0, "the steering alone took over"


def test_the_motor_turns_the_wheel_with_the_road_wheels_while_the_hands_rest(demo: Demo, table: LogTable) -> None:
    _, engaged, taken = (change["tick"] - 1 for change in demo.results["mode_changes"])
    part = slice(engaged, taken - 100)
    wheel = table.column("driver.hand_wheel_rad")[part]
    follows = 15.5 * table.column("vehicle.road_wheel_rad")[part]
    assert np.ptp(wheel) > 180.0 * RAD_PER_DEG
    assert np.sqrt(np.mean((wheel - follows) ** 2)) < 3.0 * RAD_PER_DEG
    assert table.column("torque.enabled")[part].all()
    assert np.abs(table.column("torque.torque_nm")).max() <= 4.0


def test_the_car_drives_off_from_standstill_and_stands_at_the_end(table: LogTable) -> None:
    speed = table.column("vehicle.vx_mps")
    assert abs(speed[0]) < 1e-3
    assert abs(speed[-1]) < 0.01
    assert table.column("vehicle.engine_running").all(), "the person never stalls it"


def test_the_autopilot_keeps_to_the_path_and_to_its_speed(demo: Demo, table: LogTable) -> None:
    part = demo.results["autonomous"]
    assert part["lateral_rms_m"] <= 0.03
    assert part["lateral_max_m"] <= 0.12
    assert part["mean_speed_kmh"] >= 25.0, "others, lights and people included"
    assert part["distance_m"] >= 1500.0
    assert demo.results["above_limit_s"] == 0.0
    driven = table.column("arbitration.mode") == float(Mode.AUTONOMOUS)
    assert (np.abs(table.column("vehicle.ay_mps2")[driven]) <= 2.5).mean() >= 0.999


def test_beside_the_figure_stands_what_the_autopilot_knew_and_when(demo: Demo) -> None:
    (shown,) = [line.strip() for line in demo.done.stderr.splitlines() if line.strip().startswith("autopilot's link")]
    told = "2 cm noise of position, 0.2 deg noise of yaw, 40 ms delay, at 50 Hz"
    assert shown.removeprefix("autopilot's link").strip() == told


def test_the_person_keeps_to_the_path_too(demo: Demo) -> None:
    part = demo.results["manual"]
    assert part["distance_m"] >= 850.0
    assert 0.05 < part["lateral_deviation_m"] < 0.35
    assert part["lateral_rms_m"] < 0.4


def test_both_obey_and_touch_nobody(demo: Demo, table: LogTable) -> None:
    assert demo.results["rules"] == []
    for rule in RULES:
        assert not table.column(f"rules.{rule}").any()
    assert len(list(recorded_road_users(open_bundle(demo.bundle).log))[-1].users) > 30
    lights = table.column("situation.signal_distance_m")
    assert (np.diff(np.sign(lights)) < 0.0).any(), "the person drove over a stop line"
    autonomous = table.column("arbitration.mode") == float(Mode.AUTONOMOUS)
    owed = table.column("situation.yield_m") < FAR
    assert (owed & autonomous).any(), "the autopilot let somebody pass"
    assert (owed & ~autonomous).any(), "so did the person"
    road = demo.results["road"]
    assert road["whole"]["lights_passed"] >= 1
    assert min(road[side]["let_pass"] for side in ("autonomous", "manual")) >= 1


def test_the_drive_never_waited_in_vain_and_computed_less_than_it_lasts(
    demo: Demo, record_property: Callable[[str, object], None]
) -> None:
    assert demo.results["unanswered"] == 0
    assert demo.results["exchanges"] >= demo.results["duration_s"] * 49.0, "50 exchanges in each simulated second"
    record_property("demo", f"real-time factor {demo.results['real_time_factor']:.1f}, {demo.cpu_s:.0f} s of CPU time")
    assert demo.cpu_s < demo.results["duration_s"], "driving, report and scene together"


def test_every_command_in_autonomy_was_made_for_the_state_before(table: LogTable) -> None:
    autonomous = table.column("arbitration.mode") == float(Mode.AUTONOMOUS)
    age = table.column("ros.age_ticks")[autonomous]
    assert age.max() == 4.0, "a command every 20 ms, answered in lockstep, is at most 4 ticks of 4 ms old"
    assert table.column("ros.refused").max() == 0.0


def test_samples_come_from_the_wheels_own_polarity(table: LogTable) -> None:
    # T500 RS on Linux: a released pedal reads +1 after its 10 bits went through SDL, a pressed one -1.
    profile = load("devices", "t500rs_th8rs", CockpitProfile)
    for pedal in PEDALS:
        raw = table.column(f"sample.{pedal}_axis")
        axis = getattr(profile.pedals, pedal)
        assert axis.rest_raw > 0.9 > -0.9 > axis.full_raw
        assert np.median(raw) > 0.98, pedal
        assert raw.min() < 0.8, f"{pedal} was used"
        assert table.column(f"driver.{pedal}")[raw == raw.max()].max() == 0.0
    steps = table.column("sample.wheel_axis") * 32768.0
    assert (steps == np.round(steps)).all(), "16 bits, as SDL hands them over"
    turned_rad = steps / 32768.0 * 0.5 * profile.wheel.lock_to_lock_deg * RAD_PER_DEG
    assert np.ptp(turned_rad) == pytest.approx(np.ptp(table.column("driver.hand_wheel_rad")), abs=1e-3)
    assert np.ptp(turned_rad) > 180.0 * RAD_PER_DEG, "the course has corners"


def test_gears_are_shifted_one_by_one_through_the_h_pattern(table: LogTable) -> None:
    buttons = table.column("sample.shifter_buttons").astype(int)
    held = set(buttons.tolist())
    assert 0 in held
    assert all(mask & (mask - 1) == 0 for mask in held), "never two gears at once"
    profile = load("devices", "t500rs_th8rs", CockpitProfile)
    gear_of = {0: 0, **{1 << button: gear for gear, button in enumerate(profile.shifter.gears, start=1)}}
    lever = [gear_of[int(buttons[0])]]
    lever += [gear_of[int(after)] for before, after in pairwise(buttons) if before != after]
    assert lever[:6] == [0, 1, 0, 2, 0, 3], "through neutral between two gears"
    manual = table.column("arbitration.mode") == float(Mode.MANUAL)
    driven = table.column("vehicle.gear")[manual]
    assert {1.0, 2.0, 3.0} <= set(driven.tolist())


def test_the_cockpit_is_live_throughout(table: LogTable) -> None:
    for part in PARTS:
        assert table.column(f"driver.{part}_validity")[-1] == Validity.LIVE, part
        assert not (table.column(f"driver.{part}_validity") > float(Validity.LIVE)).any(), part
    assert not (table.column("events.events").astype(int) & int(Event.EMERGENCY_STOP)).any()


def test_perfect_takes_noise_and_delay_from_the_link_and_nothing_else() -> None:
    usual, perfect = (demo_session(perfect=exact).outputs.bridge for exact in (False, True))
    assert usual is not None
    assert perfect is not None
    assert link_label(usual.link) != link_label(perfect.link) == "perfect odometry, no delay"
    assert msgspec.structs.replace(perfect, link=usual.link) == usual
    rest = [
        msgspec.structs.replace(session, outputs=msgspec.structs.replace(session.outputs, bridge=None))
        for session in (demo_session(), demo_session(perfect=True))
    ]
    assert rest[0] == rest[1]
