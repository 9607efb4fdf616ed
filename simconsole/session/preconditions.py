"""What a session must have to open: a commander and links for its pacing, a world for its vehicle, a free port."""

from typing import Final

from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError

FREE: Final = "mode.pacing: value free (with --headless realtime becomes free)"


def check_world(resolved: ResolvedSession) -> None:
    """Refuse a world whose walls the vehicle would drive through.

    Raises:
        ProfileError: the vehicle is no robot, and the world an arena.
    """
    if isinstance(resolved.world, ArenaProfile) and not isinstance(resolved.vehicle, TurtlebotProfile):
        session = resolved.session
        raise ProfileError(
            f"environment.world: value {session.environment.world}: a course or a road map, where scenario.vehicle is"
            f" {session.scenario.vehicle}: an arena's walls stop robots only"
        )


def check_session(session: SessionProfile, *, has_controller: bool = False) -> None:
    """Refuse what could never be driven or would be left out in silence, before anything is compiled or opened.

    Args:
        session: what is to be driven.
        has_controller: code of the lab's own commands, in the place of whoever the session names.

    Raises:
        ProfileError: its commander has no way in, or what it asks needs another pacing.
    """
    if not has_controller:
        check_controller(session)
    _check_commander(session)
    if session.mode.pacing == "realtime":
        return
    if session.mode.pacing == "free" and session.features.autopilot is not None and not has_controller:
        raise ProfileError(f"{FREE}: lockstep or realtime, where features.autopilot drives")
    if session.outputs.bridge is not None:
        _check_links(session.outputs.bridge, session.mode.pacing)


def check_controller(session: SessionProfile) -> None:
    """Refuse a controller by name that nobody would call, or that would not be alone.

    Raises:
        ProfileError: the drive is not in lockstep, or somebody else commands, too.
    """
    features = session.features
    if features.controller is None:
        return
    told = f"features.controller: value {features.controller.name}"
    if session.mode.pacing != "lockstep":
        raise ProfileError(f"{told}: needs mode.pacing lockstep; it is {session.mode.pacing}")
    others = {"autopilot": features.autopilot, "commands": features.commands}
    for key, other in others.items():
        if other is not None:
            raise ProfileError(f"{told}: without features.{key}: one controller at a time")


def _check_commander(session: SessionProfile) -> None:
    features = session.features
    if features.speed_advice and session.outputs.bridge is None:
        raise ProfileError("features.speed_advice: value true: needs outputs.bridge, whose topics it goes by")
    if features.commands is not None and (session.mode.pacing != "free" or features.autopilot is not None):
        raise ProfileError(f"features.commands: value {features.commands}: mode.pacing free, and no autopilot")
    if features.commander != "can":
        return
    if session.outputs.can is None:
        raise ProfileError("features.commander: value can: needs outputs.can")
    if session.mode.pacing == "lockstep":
        raise ProfileError("mode.pacing: value lockstep: realtime or free, where features.commander is can")


def _check_links(bridge: BridgeProfile, pacing: str) -> None:
    if bridge.camera is not None:
        raise ProfileError(f"mode.pacing: value {pacing}: realtime, where outputs.bridge.camera is to be drawn")
    if pacing == "lockstep":
        return
    if bridge.upstream is not None:
        raise ProfileError(f"{FREE}: realtime, where outputs.bridge.upstream is to be connected to")
    if bridge.ros2 is not None:
        raise ProfileError(f"{FREE}: lockstep or realtime, where outputs.bridge.ros2 joins a graph")


def check_address(profile: BridgeProfile) -> None:
    """Take the bridge's port for a moment: one in use is one error now, not a worker that fails at each restart.

    It does not listen there: a client that came just then would be cut off.

    Raises:
        BridgeError: it cannot listen there, or what it needs is not installed.
        ProfileError: its own message types cannot be used.
    """
    from simconsole.bridge.ros2.node import check
    from simconsole.bridge.transport.message_files import load_registry
    from simconsole.bridge.transport.sockets import bind

    load_registry(profile)
    check(profile)
    bind(profile.host, profile.port).close()
