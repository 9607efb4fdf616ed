"""A session with several platforms, taken apart: one session of one platform for each."""

import msgspec

from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.session import PlatformSection, SessionProfile, Start
from simconsole.profiles.vehicle import TurtlebotProfile, VehicleProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.session.resolution import with_start
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError


def members(resolved: ResolvedSession) -> tuple[ResolvedSession, ...]:
    """Return the session of each platform, its name being its namespace; the order is that of the session.

    Errors of lidar, inertial unit and odometry are drawn from the session's seeds for the first platform, and from the
    numbers that follow for the next ones: two robots of one kind do not err alike.

    Raises:
        ProfileError: it asks for what several platforms do not have.
    """
    session = resolved.session
    bridge, arena = _checked(session, resolved)
    taken = []
    for number, (platform, vehicle) in enumerate(zip(session.scenario.platforms, resolved.fleet, strict=True)):
        link = msgspec.structs.replace(bridge.link, seed=bridge.link.seed + number)
        own_bridge = msgspec.structs.replace(bridge, namespace=f"{bridge.namespace}/{platform.name}", link=link)
        outputs = msgspec.structs.replace(session.outputs, bridge=own_bridge)
        own = with_start(session, _start(platform, number, arena))
        own = msgspec.structs.replace(own, outputs=outputs)
        taken.append(msgspec.structs.replace(resolved, session=own, vehicle=_own(vehicle, number), fleet=()))
    return tuple(taken)


def _own(vehicle: VehicleProfile, number: int) -> TurtlebotProfile:
    """Return the robot with errors of its own."""
    if not isinstance(vehicle, TurtlebotProfile):
        raise ProfileError(f"scenario.platforms: value {number}: robots only drive together, and its vehicle is none")
    errors = msgspec.structs.replace(vehicle.odometry, seed=vehicle.odometry.seed + number)
    robot: TurtlebotProfile = msgspec.structs.replace(vehicle, odometry=errors)
    return robot


def _start(platform: PlatformSection, number: int, arena: ArenaProfile) -> Start:
    if platform.start is not None:
        return platform.start
    named = {spot.name: spot for spot in arena.starts}
    if platform.name not in named and number >= len(arena.starts):
        raise ProfileError(
            f"scenario.platforms: {platform.name}: start: value missing: the arena has {len(named)} starts"
        )
    spot = named.get(platform.name) or arena.starts[number]
    return Start(x_m=spot.x_m, y_m=spot.y_m, yaw_deg=spot.yaw_deg)


def _checked(session: SessionProfile, resolved: ResolvedSession) -> tuple[BridgeProfile, ArenaProfile]:
    """Return bridge and arena of a session that can be driven.

    Raises:
        ProfileError: it has none, or asks for what is one platform's alone.
    """
    bridge, arena = session.outputs.bridge, resolved.world
    alone = {
        "mode.pacing: lockstep": session.mode.pacing == "lockstep",
        "mode.start: at_once": session.mode.start == "at_once",
        "devices.driver: none": session.devices.driver == "none",
        "outputs.can: none": session.outputs.can is None,
        "features.autopilot: none": session.features.autopilot is None,
        "environment.traffic: none": session.environment.traffic is None,
        "scenario.faults: none": not session.scenario.faults,
    }
    wrong = [wanted for wanted, is_so in alone.items() if not is_so]
    if wrong:
        raise ProfileError(f"scenario.platforms: several platforms need {', '.join(wrong)}")
    if bridge is None or bridge.upstream is not None or bridge.ros2 is not None or bridge.external_view:
        raise ProfileError(
            "scenario.platforms: several platforms need outputs.bridge, without upstream, ros2 and external_view"
        )
    if not isinstance(arena, ArenaProfile):
        raise ProfileError(f"environment.world: value {session.environment.world}: an arena, for several platforms")
    return bridge, arena
