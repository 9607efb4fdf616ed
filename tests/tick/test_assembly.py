"""From resolved profiles to a console."""

import math

import pytest
from msgspec import structs

from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.session import (
    Aids,
    Environment,
    Features,
    FrictionPatch,
    ModeSection,
    Scenario,
    SessionProfile,
    Start,
)
from simconsole.profiles.vehicle import BallProfile, CarProfile
from simconsole.tick.advance import SETTINGS
from simconsole.tick.assembly import ResolvedSession, assemble, ground_of, obstacles_of, switched
from simconsole.values.host.jit import plain
from simconsole.values.layout import read
from simconsole.values.platform import NO_OBSTACLES, Patch
from simconsole.values.signals import Commander
from simconsole.values.state_vector import Snapshot
from tests.vehicle.altered import HATCHBACK


def test_the_session_names_wind_and_patches() -> None:
    patch = FrictionPatch(from_x_m=1.0, to_x_m=2.0, from_y_m=3.0, to_y_m=4.0, friction_share=0.5)
    ground = ground_of(Environment(wind_mps=10.0, wind_to_deg=90.0, friction_patches=(patch,)))
    assert (ground.wind_x_mps, ground.wind_y_mps) == (pytest.approx(0.0, abs=1e-9), 10.0)
    assert ground.patches == (Patch(1.0, 2.0, 3.0, 4.0, 0.5),)


def test_slopes_are_written_in_percent_and_a_side_of_the_friction_as_a_share() -> None:
    ground = ground_of(Environment(friction=0.8, friction_right_share=0.5, slope_x_percent=5.0, slope_y_percent=-8.0))
    assert (ground.friction, ground.right_share, ground.slope_x, ground.slope_y) == (0.8, 0.5, 0.05, -0.08)


def test_a_session_switches_the_aids_that_it_names_and_no_others() -> None:
    asked = switched(HATCHBACK, Aids(stability_control=False, hill_hold=True))
    assert isinstance(asked, CarProfile)
    assert (asked.aids.stability_control, asked.aids.hill_hold) == (False, True)
    assert asked.aids.anti_lock == HATCHBACK.aids.anti_lock
    assert structs.replace(asked, aids=HATCHBACK.aids) == HATCHBACK
    ball = load("vehicles", "ball", BallProfile)
    assert switched(ball, Aids(anti_lock=False)) is ball


def test_a_session_becomes_a_console_at_its_rate_in_its_place() -> None:
    session = SessionProfile(
        schema=1,
        scenario=Scenario(vehicle="ball", start=Start(x_m=3.0, y_m=4.0, yaw_deg=90.0)),
        features=Features(commander="can"),
        mode=ModeSection(tick_hz=100),
    )
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    ball = load("vehicles", "ball", BallProfile)
    console, state = assemble(ResolvedSession(session=session, cockpit=cockpit, vehicle=ball), plain)
    seen = Snapshot(0, 100, state.vector).vehicle
    assert (console.tick_hz, console.substeps, state.tick) == (100, 10, 0)
    assert (seen.x_m, seen.y_m, seen.yaw_rad) == (3.0, 4.0, pytest.approx(math.pi / 2.0))
    assert read(console.settings, SETTINGS.control).preferred_commander == Commander.ECU


def test_walls_of_an_arena_are_in_the_way_of_robots_and_other_worlds_have_none() -> None:
    found = obstacles_of(load_world("arena"))
    assert (0.0, 0.0, 9.0, 0.0) in found.segments
    assert (4.5, 4.9, 0.15) in found.circles
    assert obstacles_of(load_world("urban")) == obstacles_of(None) == NO_OBSTACLES
