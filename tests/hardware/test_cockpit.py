"""What only a real cockpit and a person can show. docs/hardware.md is the check-list; the numbers are its own."""

import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from itertools import pairwise

import pytest

from simconsole.devices.haptics.back_ends import open_motor
from simconsole.devices.setup.force_feedback_check import check_force_feedback
from simconsole.profiles.device import CockpitProfile
from simconsole.values.signals import NEVER_TICKS
from tests.hardware.conftest import HZ, Bench

Ask = Callable[[str], str]
PEDALS = ("throttle", "brake", "clutch")
PUSH = """
import sys, time
from simconsole.devices import sdl_runtime
from simconsole.devices.haptics.back_ends import open_motor
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.profiles.files.loader import load
from simconsole.profiles.device import CockpitProfile
cockpit = load("devices", sys.argv[1], CockpitProfile)
source = SdlSource(cockpit)
role = next(at for at in cockpit.roles if at.role == "wheel")
port = open_motor(source.instance_id("wheel"), (role.vendor_id, role.product_id), cockpit.force_feedback)
port.write(0.2)
print("pushing", flush=True)
for tick in range(1000):
    port.start()
    time.sleep(0.05)
"""


def test_h01_devices_are_bound_by_identity_and_rest(bench: Bench, ask: Ask) -> None:
    ask("Hands and feet off, lever in neutral, wheel straight. Enter.")
    seen = bench.watch(2.0)
    _, driver = seen[-1]
    assert (driver.throttle, driver.brake, driver.clutch, driver.gear) == (0.0, 0.0, 0.0, 0.0)
    assert abs(driver.hand_wheel_rad) < math.radians(5.0)
    assert all(sample.wheel_age_ticks == 0.0 for sample, _ in seen)


@pytest.mark.parametrize("pedal", PEDALS)
def test_h02_pedal_reaches_both_ends_and_moves_no_other(bench: Bench, ask: Ask, pedal: str) -> None:
    bench.watch(0.2)
    ask(f"After Enter: press the {pedal.upper()} fully and let it go, within five seconds.")
    seen = bench.watch(5.0)
    assert max(getattr(driver, pedal) for _, driver in seen) == 1.0
    assert getattr(seen[-1][1], pedal) == 0.0
    for other in set(PEDALS) - {pedal}:
        assert max(getattr(driver, other) for _, driver in seen) == 0.0, other


def test_h03_wheel_is_left_positive_and_turns_its_degrees(bench: Bench, ask: Ask) -> None:
    bench.watch(0.2)
    ask("After Enter: to the LEFT lock, then to the RIGHT lock, within eight seconds.")
    angles = [driver.hand_wheel_rad for _, driver in bench.watch(8.0)]
    lock_rad = math.radians(0.5 * bench.cockpit.wheel.lock_to_lock_deg)
    assert angles.index(max(angles)) < angles.index(min(angles)), "left came first"
    assert max(angles) == pytest.approx(lock_rad, rel=0.03)
    assert min(angles) == pytest.approx(-lock_rad, rel=0.03)


def test_h04_lever_shows_every_gear(bench: Bench, ask: Ask) -> None:
    if bench.cockpit.shifter.pattern != "h":
        assert ask("No H pattern in this profile. Do the paddles step? [y/n]") == "y"
        return
    bench.watch(0.2)
    for gear in (*range(1, len(bench.cockpit.shifter.gears) + 1), -1):
        ask(f"Lever into {'REVERSE' if gear < 0 else gear}, hold. Enter.")
        assert bench.watch(0.3)[-1][1].gear == gear
    ask("Lever into neutral. Enter.")
    assert bench.watch(0.5)[-1][1].gear == 0.0


def test_h05_reports_come_as_often_as_the_device_sends_them(
    bench: Bench, ask: Ask, record_property: Callable[[str, object], None]
) -> None:
    ask("After Enter: turn the wheel to and fro for five seconds, without a pause.")
    axes = [sample.wheel_axis for sample, _ in bench.watch(5.0)]
    changed = sum(one != other for one, other in pairwise(axes)) / len(axes)
    steps = sorted({round(abs(one - other) * 32768) for one, other in pairwise(axes)} - {0})
    record_property("wheel", f"{changed:.0%} of {HZ} Hz samples new while turning, smallest step {steps[0]} of 32768")
    assert changed > 0.5


def test_h06_unplugging_is_seen_at_once_and_plugging_in_binds_again(bench: Bench, ask: Ask) -> None:
    bench.watch(0.2)
    ask("Press the throttle fully and hold it. Enter; then pull the wheel's USB plug within ten seconds.")
    seen = bench.watch(10.0)
    gone = next(index for index, (sample, _) in enumerate(seen) if sample.wheel_age_ticks == NEVER_TICKS)
    assert {driver.throttle for _, driver in seen[gone:]} == {0.0}
    assert max(driver.brake for _, driver in seen) == 0.0, "no half brake on the way"
    ask("Foot off, plug it in again, wait until it has found its middle. Enter.")
    assert bench.watch(3.0)[-1][0].wheel_age_ticks == 0.0


@pytest.mark.parametrize("back_end", ["sdl", "evdev"])
def test_h07_every_force_is_felt_the_sign_first(cockpit: CockpitProfile, ask: Ask, back_end: str) -> None:
    import msgspec

    assert cockpit.force_feedback is not None, "a profile with force feedback"
    force = msgspec.structs.replace(cockpit.force_feedback, back_end=back_end)
    chosen = msgspec.structs.replace(cockpit, force_feedback=force)
    assert check_force_feedback(chosen, say=lambda line: None, ask=ask)["ok"]


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGSTOP, signal.SIGTERM])
def test_h08_process_that_is_killed_or_stopped_lets_go(
    request: pytest.FixtureRequest, ask: Ask, how: signal.Signals
) -> None:
    ask("Hold the wheel loosely: it will pull gently, then stop. Enter.")
    name = request.config.getoption("--hardware")
    pushing = subprocess.Popen([sys.executable, "-c", PUSH, name], stdout=subprocess.PIPE, text=True)
    try:
        assert pushing.stdout is not None
        assert pushing.stdout.readline() == "pushing\n"
        time.sleep(1.5)
        os.kill(pushing.pid, how)
        assert ask(f"{how.name}: did the pull end at once? [y/n]") == "y"
    finally:
        pushing.kill()
        pushing.communicate()


def test_h09_motor_answers_within_the_delay_of_its_profile(
    bench: Bench, ask: Ask, record_property: Callable[[str, object], None]
) -> None:
    force, number = bench.cockpit.force_feedback, bench.source.instance_id("wheel")
    assert force is not None
    assert number is not None
    role = next(at for at in bench.cockpit.roles if at.role == "wheel")
    port = open_motor(number, (role.vendor_id, role.product_id), force)
    assert port.capability.constant, port.capability.name
    ask("Hands off the wheel, it stands straight. Enter.")
    delays = []
    try:
        for side in (0.3, -0.3) * 5:
            rest = bench.watch(0.5)[-1][0].wheel_axis
            port.write(side)
            port.start()
            seen = bench.watch(0.15)
            port.stop()
            moved = [index for index, (sample, _) in enumerate(seen) if abs(sample.wheel_axis - rest) > 2e-4]
            delays.append(moved[0] / HZ if moved else math.inf)
    finally:
        port.close()
    middle = sorted(delays)[len(delays) // 2]
    record_property("motor", f"first motion {1000.0 * middle:.0f} ms after the level was written (median of 10)")
    assert middle <= force.motor.delay_s + 0.03
