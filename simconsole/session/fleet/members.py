"""A session with several platforms, taken apart: one session of one platform for each."""

import math
from collections.abc import Mapping, Sequence
from typing import Final

import msgspec

from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.device import CockpitProfile, RoleBinding
from simconsole.profiles.files.loader import load
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.session import Devices, Outputs, PlatformSection, SessionProfile, Start
from simconsole.profiles.vehicle import VehicleProfile
from simconsole.profiles.world import ArenaProfile, WorldProfile
from simconsole.session.resolution import language_of, with_start
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError
from simconsole.values.units import DEG_PER_RAD
from simconsole.world.kinds.worlds import open_world

APART_M: Final = 15.0
"""How far apart platforms that say no start stand on a route."""


def members(resolved: ResolvedSession) -> dict[str, ResolvedSession]:
    """Return the session of each platform by its name, which is its namespace: first that of the seat, then in order.

    Errors of lidar, inertial unit and odometry are drawn from the session's seeds for the session's first platform,
    and from the numbers that follow for the next ones: two robots of one kind do not err alike.

    Raises:
        ProfileError: it asks for what several platforms do not have.
    """
    session = resolved.session
    _check(session)
    _check_traffic(session, resolved.fleet)
    seat = session.scenario.seat or session.scenario.platforms[0].name
    taken = {}
    for number, (platform, vehicle) in enumerate(zip(session.scenario.platforms, resolved.fleet, strict=True)):
        own = with_start(session, _start(platform, number, session, resolved.world))
        own = _of_its_own(own, platform, number, platform.name == seat)
        taken[platform.name] = msgspec.structs.replace(
            resolved,
            session=own,
            vehicle=_erring(vehicle, number),
            cockpit=load("devices", platform.cockpit, CockpitProfile) if platform.cockpit else resolved.cockpit,
            language=language_of(platform.hud.language) if platform.hud else resolved.language,
            fleet=(),
        )
    _check_devices(taken)
    return {seat: taken.pop(seat), **taken}


def is_commanded(session: SessionProfile) -> bool:
    """Return whether the lockstep of a platform's session waits for a controller: its autopilot, or as nobody sits."""
    return session.features.autopilot is not None or session.devices.driver == "none"


def _of_its_own(session: SessionProfile, platform: PlatformSection, number: int, seated: bool) -> SessionProfile:
    """Return the session as one of its platforms has it."""
    replace = msgspec.structs.replace
    driver = platform.driver or (session.devices.driver if seated else "none")
    devices: Devices = replace(
        session.devices,
        driver=driver,
        person=platform.person or session.devices.person,
        cockpit=platform.cockpit or session.devices.cockpit,
    )
    scenario = replace(session.scenario, vehicle=platform.vehicle or session.scenario.vehicle)
    features, outputs = session.features, session.outputs
    if not seated:
        scenario, features = replace(scenario, faults=()), replace(features, commands=None)
    if session.mode.pacing == "realtime":
        outputs = _shown(outputs, platform, seated)
    if not platform.autopilot:
        features = replace(features, autopilot=None)
    if outputs.bridge is not None:
        outputs = replace(outputs, bridge=_bridge(outputs.bridge, platform.name, number))
    own: SessionProfile = replace(session, devices=devices, scenario=scenario, features=features, outputs=outputs)
    return own


def _shown(outputs: Outputs, platform: PlatformSection, seated: bool) -> Outputs:
    """Return the outputs with the window of one platform; sound and operators' recording are the seat's."""
    own: Outputs = outputs if seated else msgspec.structs.replace(outputs, hud=None, scene=None, sound=None)
    return own if platform.hud is None else msgspec.structs.replace(own, hud=platform.hud)


def _bridge(bridge: BridgeProfile, name: str, number: int) -> BridgeProfile:
    link = msgspec.structs.replace(bridge.link, seed=bridge.link.seed + number)
    own: BridgeProfile = msgspec.structs.replace(bridge, namespace=f"{bridge.namespace}/{name}", link=link)
    return own


def _erring(vehicle: VehicleProfile, number: int) -> VehicleProfile:
    """Return the vehicle, a robot with errors of its own."""
    if not isinstance(vehicle, TurtlebotProfile):
        return vehicle
    errors = msgspec.structs.replace(vehicle.odometry, seed=vehicle.odometry.seed + number)
    robot: TurtlebotProfile = msgspec.structs.replace(vehicle, odometry=errors)
    return robot


def _start(platform: PlatformSection, number: int, session: SessionProfile, world: WorldProfile | None) -> Start:
    if platform.start is not None:
        return platform.start
    if isinstance(world, ArenaProfile):
        return _start_in(world, platform, number)
    at_m, route = APART_M * number, None if world is None else open_world(world).route
    if number == 0 and session.scenario.start is not None:
        return session.scenario.start
    if route is None or at_m > route.length_m - APART_M:
        there = "the session has no world" if route is None else f"the route of {route.length_m:g} m is full"
        raise ProfileError(f"scenario.platforms: {platform.name}: start: value missing: {there}")
    place = route.at(at_m)
    yaw_deg = math.remainder(place.yaw_rad, math.tau) * DEG_PER_RAD
    return Start(x_m=place.x_m, y_m=place.y_m, yaw_deg=min(max(yaw_deg, -180.0), 180.0))


def _start_in(arena: ArenaProfile, platform: PlatformSection, number: int) -> Start:
    named = {spot.name: spot for spot in arena.starts}
    if platform.name not in named and number >= len(arena.starts):
        raise ProfileError(
            f"scenario.platforms: {platform.name}: start: value missing: the arena has {len(named)} starts"
        )
    spot = named.get(platform.name) or arena.starts[number]
    return Start(x_m=spot.x_m, y_m=spot.y_m, yaw_deg=spot.yaw_deg)


def _check(session: SessionProfile) -> None:
    """Refuse what is one platform's alone.

    Raises:
        ProfileError: names it.
    """
    bridge = session.outputs.bridge
    alone = {
        "mode.start: at_once": session.mode.start == "at_once",
        "outputs.can: none": session.outputs.can is None,
        "features.speed_advice: false where a clock paces the drive": session.mode.pacing != "realtime"
        or not session.features.speed_advice,
    }
    wrong = [wanted for wanted, is_so in alone.items() if not is_so]
    if wrong:
        raise ProfileError(f"scenario.platforms: several platforms need {', '.join(wrong)}")
    if session.mode.pacing == "lockstep" and bridge is None:
        raise ProfileError("scenario.platforms: several platforms in lockstep need outputs.bridge")
    if bridge is not None and (bridge.upstream or bridge.ros2 or bridge.external_view or bridge.camera):
        raise ProfileError(
            "scenario.platforms: outputs.bridge: without upstream, ros2, external_view and camera, for several"
        )


def _check_devices(parts: Mapping[str, ResolvedSession]) -> None:
    """Refuse two persons at one device.

    Raises:
        ProfileError: names platforms and device.
    """
    taken: list[tuple[str, RoleBinding]] = []
    for name, part in parts.items():
        if part.session.devices.driver != "sdl":
            continue
        for role in part.cockpit.roles:
            other = next((whose for whose, theirs in taken if _may_be_one(role, theirs)), None)
            if other is not None:
                usb_id = f"{role.vendor_id:04x}:{role.product_id:04x}"
                raise ProfileError(
                    f"scenario.platforms: {name}: cockpit: role {role.role}: value {usb_id}: a device of its own, or a"
                    f" port in the profiles of both, for {other} has it"
                )
        taken += [(name, role) for role in part.cockpit.roles]


def _may_be_one(one: RoleBinding, other: RoleBinding) -> bool:
    """Return whether two roles may be played by one device."""
    at_one_port = not one.port or not other.port or one.port == other.port
    return one.key[:2] == other.key[:2] and at_one_port


def _check_traffic(session: SessionProfile, fleet: Sequence[VehicleProfile]) -> None:
    """Refuse traffic that several platforms cannot be in: built-in one, and any beside robots.

    Raises:
        ProfileError: names it.
    """
    traffic = session.environment.traffic
    if traffic is None:
        return
    if traffic.sumo is None:
        raise ProfileError("environment.traffic: value given: none, or sumo, with scenario.platforms")
    robot = next(
        (one.name for one, vehicle in zip(session.scenario.platforms, fleet, strict=True) if _is_robot(vehicle)), None
    )
    if robot is not None:
        raise ProfileError(f"scenario.platforms: {robot}: vehicle: no robot, where there is environment.traffic")


def _is_robot(vehicle: VehicleProfile) -> bool:
    return isinstance(vehicle, TurtlebotProfile)
