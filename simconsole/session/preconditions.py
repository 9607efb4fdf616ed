"""What a session must have to open: a commander and links for its pacing, a world for its vehicle, a free port."""

from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.vehicle import TurtlebotProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError


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


def check_commander(session: SessionProfile) -> None:
    """Refuse a session whose `features.commander` could never command.

    Raises:
        ProfileError: it could not.
    """
    features = session.features
    if features.commands is not None and (session.mode.pacing != "free" or features.autopilot is not None):
        raise ProfileError(f"features.commands: value {features.commands}: mode.pacing free, and no autopilot")
    if features.commander != "can":
        return
    if session.outputs.can is None:
        raise ProfileError("features.commander: value can: needs outputs.can")
    if session.mode.pacing == "lockstep":
        raise ProfileError("mode.pacing: value lockstep: realtime or free, where features.commander is can")


def check_links(session: SessionProfile) -> None:
    """Refuse what a headless drive would leave out in silence.

    Raises:
        ProfileError: it needs another pacing.
    """
    bridge = session.outputs.bridge
    if bridge is None:
        return
    if bridge.camera is not None:
        pacing = session.mode.pacing
        raise ProfileError(f"mode.pacing: value {pacing}: realtime, where outputs.bridge.camera is to be drawn")
    if session.mode.pacing == "lockstep":
        return
    if bridge.upstream is not None:
        raise ProfileError("mode.pacing: value free: realtime, where outputs.bridge.upstream is to be connected to")
    if bridge.ros2 is not None:
        raise ProfileError("mode.pacing: value free: lockstep or realtime, where outputs.bridge.ros2 joins a graph")


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
