"""From a session's name to a resolved session: every profile it names, read and checked."""

import math
from pathlib import Path
from typing import Final

import msgspec

from simconsole.profiles.device import CockpitProfile, ScriptProfile
from simconsole.profiles.files.loader import find, load
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.session import PROFILE_FILES, SessionProfile, Start
from simconsole.profiles.validation import convert
from simconsole.profiles.world import WorldProfile
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError
from simconsole.values.units import DEG_PER_RAD
from simconsole.world.kinds.worlds import open_world

_NAMED: Final = (
    ("environment", "world"),
    ("scenario", "vehicle"),
    ("features", "autopilot"),
    ("devices", "cockpit"),
)
"""Keys of a session that name another profile."""


def resolve(session: SessionProfile, cockpit: str | None = None) -> ResolvedSession:
    """Return the session with the profiles it names; `cockpit` (a name or a file) takes the place of its own.

    Raises:
        ProfileError: one of them is missing or wrong; names its file, key, value and range.
    """
    world = None if session.environment.world is None else load_world(session.environment.world)
    return ResolvedSession(
        session=session if world is None else _started(session, world),
        cockpit=load("devices", cockpit or session.devices.cockpit, CockpitProfile),
        vehicle=load_vehicle(session.scenario.vehicle),
        world=world,
    )


def _started(session: SessionProfile, world: WorldProfile) -> SessionProfile:
    """Return `session` with where it starts: at the beginning of the route, unless it says otherwise."""
    if session.scenario.start is not None:
        return session
    first = open_world(world).route.at(0.0)
    yaw_deg = math.remainder(first.yaw_rad, math.tau) * DEG_PER_RAD
    start = Start(x_m=first.x_m, y_m=first.y_m, yaw_deg=min(max(yaw_deg, -180.0), 180.0))
    return msgspec.structs.replace(session, scenario=msgspec.structs.replace(session.scenario, start=start))


def load_session(name_or_path: str) -> SessionProfile:
    """Return the session profile of that name or file; files that it names lie beside it.

    Raises:
        ProfileError: missing or wrong, or such a file lies outside its folder.
    """
    return _files_beside(load("sessions", name_or_path, SessionProfile), find("sessions", name_or_path))


def load_scenario(name_or_path: str) -> tuple[ScenarioProfile, Path]:
    """Return the scenario and its file, beside which its golden and its own profiles lie.

    Raises:
        ProfileError: missing, wrong, or a profile that it names lies outside its folder.
    """
    scenario, path = load("scenarios", name_or_path, ScenarioProfile), find("scenarios", name_or_path)
    return msgspec.structs.replace(scenario, session=_profiles_beside(scenario.session, path)), path


def load_script(name_or_path: str) -> ScriptProfile:
    """Return a person's script by the file the user named.

    Raises:
        ProfileError: missing or wrong.
    """
    return load("scenarios", name_or_path, ScriptProfile)


def override(session: SessionProfile, **sections: dict[str, object]) -> SessionProfile:
    """Return `session` with keys of its sections replaced, as command-line options do.

    Raises:
        ProfileError: a value is outside its bounds; names section and key.
    """
    plain = msgspec.to_builtins(session)
    for section, keys in sections.items():
        plain[section].update(keys)
    return convert(plain, SessionProfile, "command line")


def _files_beside(session: SessionProfile, path: Path) -> SessionProfile:
    """Return `session` with whole paths of its script or trace and its message types."""
    kind, _, name = session.devices.driver.partition(":")
    if name:
        beside = _beside(path, "devices.driver", session.devices.driver, name)
        session = override(session, devices={"driver": f"{kind}:{beside}"})
    commands = session.features.commands
    if commands is not None:
        beside = _beside(path, "features.commands", commands, commands.removeprefix("bag:"))
        session = override(session, features={"commands": f"bag:{beside}"})
    bridge = session.outputs.bridge
    if bridge is not None and bridge.messages is not None:
        beside = _beside(path, "outputs.bridge.messages", bridge.messages, bridge.messages)
        changed = {**msgspec.to_builtins(bridge), "messages": str(beside)}
        session = override(session, outputs={"bridge": changed})
    return _profiles_beside(session, path)


def _profiles_beside(session: SessionProfile, path: Path) -> SessionProfile:
    """Return `session` with the whole paths of the profiles that are not shipped ones."""
    plain = msgspec.to_builtins(session)
    for section, key in _NAMED:
        name = plain[section][key]
        if name is not None and name.endswith(PROFILE_FILES):
            changed: dict[str, object] = {key: str(_beside(path, f"{section}.{key}", name, name))}
            session = override(session, **{section: changed})
    return session


def _beside(path: Path, key: str, value: str, name: str) -> Path:
    """Return the whole path of what a profile names; a profile opens nothing outside its own folder."""
    folder = path.parent.resolve()
    beside = (folder / name).resolve()
    if not beside.is_relative_to(folder):
        raise ProfileError(f'{path}: {key}: value "{value}": a file inside {path.parent}')
    return beside
