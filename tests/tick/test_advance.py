"""One tick: pure, in its order, and the same from a recorded row."""

import numpy as np
import pytest

from simconsole.control.requests.control_settings import settings
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.tick.advance import Console, ConsoleState, advance, advance_vector, build_console, initial_state
from simconsole.values.host.jit import plain
from simconsole.values.latency import Hop
from simconsole.values.platform import Pose
from simconsole.values.signals import NO_COMMAND, NO_SAMPLE, Button, Event, EventInput, Mode, RemoteKind
from simconsole.values.state_vector import INPUT_WIDTH, LAYOUT, PLATFORM_AT, Snapshot, TickInputs, input_vector
from tests.bits import difference
from tests.vehicle.driving import platform

HZ = 250
COCKPIT = load("devices", "t500rs_th8rs", CockpitProfile)


def ball(tick_hz: int = HZ) -> Console:
    rolling = platform("ball", pose=Pose(1.0, 2.0, 0.5))
    control = settings(
        ControlProfile(person_required=False),
        rolling.steering_ratio,
        rolling.max_road_wheel_rad,
        rolling.wheelbase_m,
        tick_hz,
    )
    cockpit = cockpit_settings(COCKPIT, tick_hz)
    return build_console(cockpit, control, rolling, tick_hz, plain)


def inputs(sequence: int, events: int = 0) -> TickInputs:
    command = NO_COMMAND._replace(
        kind=float(RemoteKind.POSE), sequence=float(sequence), age_ticks=0.0, x_m=9.0, y_m=2.0, speed_mps=1.0
    )
    return TickInputs(NO_SAMPLE, command, EventInput(float(events)))


def driven(console: Console, ticks: int) -> tuple[ConsoleState, Snapshot]:
    """Return the state after so many ticks, the first half a second of which nobody has engaged anything."""
    state = initial_state(console)
    for tick in range(1, ticks + 1):
        asked = Event.REQUEST_AUTONOMOUS if tick == HZ // 2 else 0
        state, snapshot = advance(state, inputs(tick, asked), console)
    return state, snapshot


def test_before_the_first_tick_it_is_parked_in_place_and_nobody_has_said_anything() -> None:
    console = ball()
    state = initial_state(console)
    seen = Snapshot(0, HZ, state.vector)
    assert (state.tick, len(state.vector), seen.arbitration.mode) == (0, console.width, Mode.PARKED)
    assert (seen.sample, seen.ros, seen.ecu) == (NO_SAMPLE, NO_COMMAND, NO_COMMAND)
    assert (seen.vehicle.x_m, seen.vehicle.y_m) == (1.0, 2.0)
    assert tuple(state.vector[PLATFORM_AT:]) == console.platform.initial_state


@pytest.mark.parametrize("tick_hz", [3, 300, 2000])
def test_a_rate_that_is_no_whole_number_of_physics_steps_is_refused(tick_hz: int) -> None:
    with pytest.raises(ValueError, match=f"tick_hz {tick_hz} does not divide 1000"):
        build_console(*(None,) * 3, tick_hz, plain)  # type: ignore[arg-type]  # refused before anything is looked at


def test_a_tick_changes_nothing_that_it_is_given_and_keeps_its_inputs() -> None:
    console = ball()
    state, _ = driven(console, HZ)
    before, given = state.vector.copy(), inputs(HZ + 1)
    after, snapshot = advance(state, given, console)
    assert not difference(state.vector, before)
    assert (after.tick, snapshot.tick) == (HZ + 1, HZ + 1)
    assert not difference(after.vector[:INPUT_WIDTH], input_vector(given))
    assert np.isfinite(after.vector).all()


def test_a_recorded_row_goes_on_as_the_drive_did() -> None:
    console = ball()
    state, snapshot = driven(console, HZ)
    assert snapshot.arbitration.mode == Mode.AUTONOMOUS
    assert snapshot.vehicle.vx_mps > 0.1
    after, _ = advance(state, inputs(HZ + 1), console)
    again = advance_vector(state.vector, after.vector[:INPUT_WIDTH], console)
    assert not difference(again, after.vector)


def test_a_restart_puts_the_vehicle_back_in_the_very_tick_and_leaves_the_devices() -> None:
    console = ball()
    state, before = driven(console, 2 * HZ)
    assert before.vehicle.x_m > 1.1
    held = NO_SAMPLE._replace(wheel_buttons=float(1 << 6), wheel_age_ticks=0.0)  # button of the mark
    for _ in range(4 * HZ):
        state, now = advance(state, TickInputs(held, NO_COMMAND, EventInput(0.0)), console)
    assert now.arbitration.mode == Mode.STOPPED
    still = now.driver
    assert int(still.pressed) & Button.MARK
    state, now = advance(state, TickInputs(held, NO_COMMAND, EventInput(float(Event.RESTART))), console)
    assert now.arbitration.restarted == 1.0
    assert (now.arbitration.mode, now.vehicle.x_m, now.vehicle.y_m) == (Mode.PARKED, 1.0, 2.0)
    assert now.driver._replace(neutral_ticks=still.neutral_ticks) == still, "a held button is not pressed again"
    assert advance(state, TickInputs(held, NO_COMMAND, EventInput(0.0)), console)[1].arbitration.restarted == 0.0


def test_each_stage_is_marked_once_in_order_and_a_wheel_without_a_motor_is_none() -> None:
    console, marks = ball(), list[Hop]()
    state = initial_state(console)
    state.vector[LAYOUT.torque.start : LAYOUT.situation.start] = 7.0
    _, snapshot = advance(state, inputs(1), console, marks.append)
    assert marks == [Hop.DECIDE, Hop.STEP]
    assert not snapshot.vector[LAYOUT.torque.start : LAYOUT.situation.start].any()


@pytest.mark.parametrize("tick_hz", [50, 1000])
def test_a_second_is_a_second_at_any_rate(tick_hz: int) -> None:
    console = ball(tick_hz)
    assert console.substeps * console.tick_hz == 1000
    assert console.tick_s * console.tick_hz == pytest.approx(1.0)
    assert console.columns[0].startswith("sample.")
    assert len(console.columns) == console.width
