"""The simulated person at virtual devices, in the real console with the real car."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import pytest

from simconsole.control.requests.control_settings import settings as control_settings
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.drivers.cockpit.simulated_person import SimulatedPerson
from simconsole.drivers.simulated_person.behaviour import Phase
from simconsole.profiles.control import ControlProfile
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.person import PersonPlan, When
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.tick.advance import Console, advance, build_console, initial_state
from simconsole.values.host.jit import compiled
from simconsole.values.platform import Ground, Pose
from simconsole.values.signals import NO_COMMAND, NO_EVENTS, Mode, Reason, RemoteCommand, RemoteKind
from simconsole.values.state_vector import Snapshot, TickInputs
from simconsole.vehicle.platforms import build

HZ = 250
Controller = Callable[[int, Snapshot], RemoteCommand]


class Scene(NamedTuple):
    """One tick as the test looks at it."""

    phase: Phase
    snapshot: Snapshot


def console(cockpit: CockpitProfile, pose: Pose, slope_x: float = 0.0) -> Console:
    profile: VehicleProfile = load("vehicles", "hatchback", VehicleProfile)  # type: ignore[arg-type]  # a union
    platform = build(profile, pose, Ground(1.0, slope_x, 0.0))
    control = control_settings(
        ControlProfile(), platform.steering_ratio, platform.max_road_wheel_rad, platform.wheelbase_m, HZ
    )
    return build_console(cockpit_settings(cockpit, HZ), control, platform, HZ, compiled)


def nobody(tick: int, snapshot: Snapshot) -> RemoteCommand:
    return NO_COMMAND


def drive(
    cockpit: CockpitProfile,
    plan: PersonPlan,
    *,
    controller: Controller = nobody,
    pose: Pose = Pose(0.0, 0.0, 0.0),  # noqa: B008  # immutable
    slope_x: float = 0.0,
    limit_s: float = 120.0,
    meddle: Callable[[int, VirtualCockpit], None] = lambda tick, plugged: None,
) -> list[Scene]:
    """Drive until the person has finished."""
    under = console(cockpit, pose, slope_x)
    state = initial_state(under)
    plugged = VirtualCockpit(cockpit)
    source = SdlSource(cockpit)
    driver = SimulatedPerson(plan, plugged, cockpit_settings(cockpit, HZ), tick_hz=HZ)
    snapshot, scenes = Snapshot(0, HZ, state.vector), []
    try:
        for tick in range(1, round(limit_s * HZ) + 1):
            meddle(tick, plugged)
            driver.act(snapshot)
            inputs = TickInputs(source.poll(tick), controller(tick, snapshot), NO_EVENTS)
            state, snapshot = advance(state, inputs, under)
            scenes.append(Scene(driver.person.phase, snapshot))
            if driver.finished:
                return scenes
    finally:
        source.close()
        plugged.close()
    raise AssertionError(f"not finished in {limit_s} s: {driver.person.phase}, {snapshot.vehicle}, {snapshot.driver}")


def straight_ahead(tick: int, snapshot: Snapshot) -> RemoteCommand:
    """A controller at 50 Hz that holds 10 m/s on the line y = 0."""
    vehicle = snapshot.vehicle
    return NO_COMMAND._replace(
        kind=float(RemoteKind.SPEED),
        sequence=float(tick // 5 + 1),
        age_ticks=float(tick % 5),
        road_wheel_rad=-0.02 * vehicle.y_m - 0.5 * vehicle.yaw_rad,
        speed_mps=10.0,
        direction=1.0,
    )


def modes(scenes: list[Scene]) -> list[Mode]:
    """The modes in the order in which they came."""
    every = [Mode(int(scene.snapshot.arbitration.mode)) for scene in scenes]
    return [every[0], *(later for earlier, later in pairwise(every) if earlier != later)]


pytestmark = pytest.mark.usefixtures("sdl")


@pytest.fixture(scope="module")
def whole(t500: CockpitProfile) -> list[Scene]:
    """Drive off, hand over at 80 m, take back at 200 m, stop at 220 m."""
    plan = PersonPlan(
        cruise_kmh=36.0,
        autonomy=When(distance_m=80.0),
        take_back=When(distance_m=200.0),
        stop=When(distance_m=220.0),
    )
    return drive(t500, plan, controller=straight_ahead)


def during(scenes: list[Scene], *phases: Phase) -> list[Snapshot]:
    return [scene.snapshot for scene in scenes if scene.phase in phases]


def test_person_goes_through_the_gears_by_the_pattern(whole: list[Scene]) -> None:
    driven = during(whole, Phase.BITE, Phase.DRIVE, Phase.SHIFT_OPEN, Phase.SHIFT_MESH, Phase.SHIFT_CLOSE)
    gears = [snapshot.vehicle.gear for snapshot in driven if snapshot.vehicle.distance_m < 80.0]
    assert [gears[0], *(later for earlier, later in pairwise(gears) if earlier != later)] == [1.0, 2.0, 3.0]
    for before, after in pairwise(driven):
        if before.driver.gear != after.driver.gear:
            assert after.driver.clutch > 0.95


def test_engine_never_stalls_and_the_launch_does_not_labour(whole: list[Scene]) -> None:
    assert all(scene.snapshot.vehicle.engine_running for scene in whole)
    launch = during(whole, Phase.BITE)
    assert min(snapshot.vehicle.engine_radps for snapshot in launch) > 80.0
    assert len(launch) < 4.0 * HZ


def test_modes_and_reasons_are_those_of_the_plan(whole: list[Scene]) -> None:
    assert modes(whole) in (
        [Mode.PARKED, Mode.MANUAL, Mode.AUTONOMOUS, Mode.MANUAL],
        [Mode.MANUAL, Mode.AUTONOMOUS, Mode.MANUAL],
    )
    back = next(
        later.snapshot
        for earlier, later in pairwise(whole)
        if earlier.snapshot.arbitration.mode == Mode.AUTONOMOUS != later.snapshot.arbitration.mode
    )
    assert back.arbitration.reason == Reason.STEERING_OVERRIDE
    assert 200.0 < back.vehicle.distance_m < 205.0


def test_hands_and_feet_are_still_while_the_controller_drives(whole: list[Scene]) -> None:
    watching = during(whole, Phase.WATCH)
    assert len(watching) > 5 * HZ
    assert len({snapshot.driver.hand_wheel_rad for snapshot in watching}) == 1
    released = watching[HZ:]
    assert all(
        (snapshot.driver.throttle, snapshot.driver.brake, snapshot.driver.clutch) == (0.0, 0.0, 0.0)
        for snapshot in released
    )
    assert {snapshot.driver.gear for snapshot in released} == {3.0}


def test_person_ends_standing_in_neutral_on_the_line(whole: list[Scene]) -> None:
    last = whole[-1].snapshot
    assert abs(last.vehicle.vx_mps) < 0.05
    assert (last.driver.gear, last.vehicle.gear) == (0.0, 0.0)
    assert 220.0 < last.vehicle.distance_m < 260.0
    assert max(abs(scene.snapshot.vehicle.y_m) for scene in whole) < 0.6


def test_feet_and_hands_move_as_a_person_can(whole: list[Scene]) -> None:
    drivers = [scene.snapshot.driver for scene in whole[10:]]
    for before, after in pairwise(drivers):
        for pedal in ("throttle", "brake", "clutch"):
            assert abs(getattr(after, pedal) - getattr(before, pedal)) < 4.5 / HZ
        assert abs(after.hand_wheel_rad - before.hand_wheel_rad) < 4.4 / HZ


@pytest.mark.parametrize("cruise_kmh", [15.0, 60.0])
def test_lane_and_speed_are_held(cruise_kmh: float, t500: CockpitProfile) -> None:
    """The line is the straight through the start pose; a slope across it pushes."""
    plan = PersonPlan(cruise_kmh=cruise_kmh, stop=When(distance_m=350.0 if cruise_kmh > 30 else 120.0))
    scenes = drive(t500, plan, pose=Pose(100.0, -50.0, 2.5), slope_x=0.02)
    offsets = [
        (s.snapshot.vehicle.y_m + 50.0) * math.cos(2.5) - (s.snapshot.vehicle.x_m - 100.0) * math.sin(2.5)
        for s in scenes
    ]
    assert max(map(abs, offsets)) < 0.3
    speeds = [s.snapshot.vehicle.vx_mps * 3.6 for s in scenes if s.phase is Phase.DRIVE]
    assert max(speeds) == pytest.approx(cruise_kmh, abs=3.0)


def test_refused_autonomy_is_asked_for_again(t500: CockpitProfile) -> None:
    """The controller wakes up late: the first presses are refused, the person drives on and presses again."""

    def late(tick: int, snapshot: Snapshot) -> RemoteCommand:
        return straight_ahead(tick, snapshot) if tick > 22 * HZ else NO_COMMAND

    plan = PersonPlan(cruise_kmh=30.0, autonomy=When(distance_m=40.0), take_back=When(time_s=30.0))
    scenes = drive(t500, plan, controller=late)
    assert Mode.AUTONOMOUS in modes(scenes)
    refused = [s for s in scenes if s.snapshot.arbitration.refusal == Reason.REFUSED_NO_COMMAND]
    assert refused
    assert modes(scenes)[-1] == Mode.MANUAL


def test_silent_controller_makes_the_person_take_over(t500: CockpitProfile) -> None:
    def dies(tick: int, snapshot: Snapshot) -> RemoteCommand:
        command = straight_ahead(tick, snapshot)
        return command if tick < 25 * HZ else command._replace(sequence=1.0, age_ticks=float(tick - 25 * HZ))

    plan = PersonPlan(cruise_kmh=36.0, autonomy=When(distance_m=60.0), take_back=When(distance_m=5000.0))
    scenes = drive(t500, plan, controller=dies)
    assert Mode.MINIMAL_RISK in modes(scenes)
    assert abs(scenes[-1].snapshot.vehicle.vx_mps) < 0.05


def test_shifter_pulled_out_and_back_does_not_end_the_drive(t500: CockpitProfile) -> None:
    def pull(tick: int, plugged: VirtualCockpit) -> None:
        if tick == 18 * HZ:
            plugged.unplug("shifter")
        elif tick == 19 * HZ:
            plugged.plug("shifter")

    scenes = drive(t500, PersonPlan(cruise_kmh=36.0, stop=When(distance_m=150.0)), meddle=pull)
    assert all(scene.snapshot.vehicle.engine_running for scene in scenes)
    assert scenes[-1].snapshot.vehicle.distance_m < 200.0
