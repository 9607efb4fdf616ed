"""From a session's name to a resolved session: every profile it names, read and checked."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, TypeVar

import msgspec

from simconsole.hud.phrases import check_language
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import find, load
from simconsole.profiles.files.vehicle_files import load_vehicle
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.session import PlatformSection, SessionProfile, Start
from simconsole.profiles.validation import PROFILE_FILES, convert
from simconsole.profiles.vehicle import CarProfile, VehicleProfile
from simconsole.profiles.view import HudProfile, LanguageProfile
from simconsole.profiles.world import ArenaProfile, WorldProfile
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError
from simconsole.values.units import DEG_PER_RAD
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of

_NAMED: Final = (
    ("environment", "world"),
    ("scenario", "vehicle"),
    ("features", "autopilot"),
    ("devices", "cockpit"),
)
"""Keys of a session that name another profile."""
_PROFILES: Final = ("vehicle", "cockpit", "world")
_SECTIONS: Final = SessionProfile.__struct_fields__
_CLEAR_M: Final = 1.0
"""So far beyond the beginning of a road a vehicle's rear stands: people walk across there."""

T = TypeVar("T")


def resolve(session: SessionProfile, cockpit: str | None = None, language: str | None = None) -> ResolvedSession:
    """Return the session with the profiles it names; `cockpit` and `language` (names or files) replace its own.

    Raises:
        ProfileError: one of them is missing or wrong; names its file, key, value and range.
    """
    world = None if session.environment.world is None else load_world(session.environment.world)
    named = [platform.vehicle or session.scenario.vehicle for platform in session.scenario.platforms]
    vehicle = load_vehicle(session.scenario.vehicle)
    return ResolvedSession(
        session=session if world is None else _started(session, world, vehicle),
        cockpit=load("devices", cockpit or session.devices.cockpit, CockpitProfile),
        vehicle=vehicle,
        world=world,
        language=language_of(language or (session.outputs.hud or HudProfile()).language),
        fleet=tuple(load_vehicle(name) for name in named),
    )


def language_of(name_or_path: str) -> LanguageProfile:
    """Return the language of that name or file.

    Raises:
        ProfileError: missing or wrong, or it names a phrase that the display never says.
    """
    language = load("languages", name_or_path, LanguageProfile)
    check_language(language, str(find("languages", name_or_path)))
    return language


def _started(session: SessionProfile, world: WorldProfile, vehicle: VehicleProfile) -> SessionProfile:
    """Return `session` with where it starts: the arena's first start, or the beginning of the route.

    On a road map the whole car stands on its road, clear of the junction behind it. A session that says where it starts
    is returned as it is.
    """
    if session.scenario.start is not None:
        return session
    if isinstance(world, ArenaProfile):
        spot = world.starts[0]
        return with_start(session, Start(x_m=spot.x_m, y_m=spot.y_m, yaw_deg=spot.yaw_deg))
    opened, first_m = open_world(world), 0.0
    if roads_of(opened) is not None and isinstance(vehicle, CarProfile):
        first_m = vehicle.body.rear_overhang_m + _CLEAR_M
    first = opened.route.at(first_m)
    yaw_deg = math.remainder(first.yaw_rad, math.tau) * DEG_PER_RAD
    start = Start(x_m=first.x_m, y_m=first.y_m, yaw_deg=min(max(yaw_deg, -180.0), 180.0))
    return with_start(session, start)


def with_start(session: SessionProfile, start: Start) -> SessionProfile:
    """Return `session` with another start."""
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
    return msgspec.structs.replace(scenario, session=_files_beside(scenario.session, path)), path


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


def headless(session: SessionProfile) -> SessionProfile:
    """Return `session` as a drive without a window and without a clock; one in lockstep stays in lockstep."""
    pacing = "free" if session.mode.pacing == "realtime" else session.mode.pacing
    return override(session, outputs={"hud": None}, mode={"pacing": pacing})


def parted(values: Mapping[str, object]) -> tuple[dict[str, object], dict[str, object]]:
    """Return the values of a session's own keys, and those of the profiles that it names.

    A key is dotted (`environment.friction`). One of another profile begins with `vehicle`, `cockpit` or `world`; what
    begins with none of these and with no section of a session is a key of the vehicle (`body.mass_kg`).
    """
    of_session = {key: value for key, value in values.items() if key.partition(".")[0] in _SECTIONS}
    return of_session, {key: value for key, value in values.items() if key not in of_session}


def with_session_values(session: SessionProfile, values: Mapping[str, object], origin: str) -> SessionProfile:
    """Return `session` with the values of these dotted keys; `origin` opens an error.

    Raises:
        ProfileError: no such key, or a value out of its bounds.
    """
    return _with_values(session, SessionProfile, values, origin)


def with_named_values(resolved: ResolvedSession, values: Mapping[str, object], origin: str) -> ResolvedSession:
    """Return `resolved` with values in the profiles that its session names; keys as of `parted`.

    Raises:
        ProfileError: no such profile or key, or a value out of its bounds.
    """
    grouped: dict[str, dict[str, object]] = {}
    for key, value in values.items():
        first, _, rest = key.partition(".")
        name, inner = (first, rest) if first in _PROFILES else ("vehicle", key)
        grouped.setdefault(name, {})[inner] = value
    for name, inside in grouped.items():
        profile = getattr(resolved, name)
        if profile is None:
            raise ProfileError(f"{origin}: {name}: the session has none")
        changed: dict[str, object] = {name: _with_values(profile, type(profile), inside, f"{origin}: {name}")}
        resolved = msgspec.structs.replace(resolved, **changed)
    return resolved


def _with_values(profile: object, struct: type[T], values: Mapping[str, object], origin: str) -> T:
    plain = msgspec.to_builtins(profile)
    for key, value in values.items():
        *way, last = key.split(".")
        at = plain
        for step in way:
            if at.get(step) is None:
                at[step] = {}  # an empty section, or an unknown key, which `convert` names
            at = at[step]
            if not isinstance(at, dict):
                raise ProfileError(f"{origin}: {key}: {step} has no keys of its own")
        at[last] = value
    return convert(plain, struct, origin)


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
    traffic = session.environment.traffic
    if traffic is not None and traffic.sumo is not None and traffic.sumo.config is not None:
        beside = _beside(path, "environment.traffic.sumo.config", traffic.sumo.config, traffic.sumo.config)
        sumo = msgspec.structs.replace(traffic.sumo, config=str(beside))
        changed = msgspec.to_builtins(msgspec.structs.replace(traffic, sumo=sumo))
        session = override(session, environment={"traffic": changed})
    hud = session.outputs.hud
    if hud is not None:
        session = override(session, outputs={"hud": _display_files_beside(hud, path)})
    return _profiles_beside(session, path)


def _display_files_beside(hud: HudProfile, path: Path) -> dict[str, object]:
    """Return the plain values of `hud` with whole paths of its language and its models."""
    plain: dict[str, Any] = msgspec.to_builtins(hud)
    if hud.language.endswith(PROFILE_FILES):
        plain["language"] = str(_beside(path, "outputs.hud.language", hud.language, hud.language))
    view = plain["view"] or {}
    named = [("models", model) for model in view.get("models", ())]
    for key, model in (("vehicle_model", view.get("vehicle_model")), *named):
        if model is not None:
            model["file"] = str(_beside(path, f"outputs.hud.view.{key}.file", model["file"], model["file"]))
    return plain


def _profiles_beside(session: SessionProfile, path: Path) -> SessionProfile:
    """Return `session` with the whole paths of the profiles that are not shipped ones."""
    plain = msgspec.to_builtins(session)
    for section, key in _NAMED:
        name = plain[section][key]
        if name is not None and name.endswith(PROFILE_FILES):
            changed: dict[str, object] = {key: str(_beside(path, f"{section}.{key}", name, name))}
            session = override(session, **{section: changed})
    platforms = tuple(_platform_beside(platform, path) for platform in session.scenario.platforms)
    return msgspec.structs.replace(session, scenario=msgspec.structs.replace(session.scenario, platforms=platforms))


def _platform_beside(platform: PlatformSection, path: Path) -> PlatformSection:
    """Return one of several platforms with the whole paths of the files that it names."""
    kind, _, name = (platform.driver or "").partition(":")
    for key in ("vehicle", "cockpit"):
        named = getattr(platform, key)
        if named is not None and named.endswith(PROFILE_FILES):
            own: dict[str, object] = {key: str(_beside(path, f"platforms.{key}", named, named))}
            platform = msgspec.structs.replace(platform, **own)
    if platform.hud is not None:
        shown = convert(_display_files_beside(platform.hud, path), HudProfile, str(path))
        platform = msgspec.structs.replace(platform, hud=shown)
    if name:
        beside = _beside(path, "platforms.driver", platform.driver or "", name)
        platform = msgspec.structs.replace(platform, driver=f"{kind}:{beside}")
    return platform


def _beside(path: Path, key: str, value: str, name: str) -> Path:
    """Return the whole path of what a profile names; a profile opens nothing outside its own folder."""
    folder = path.parent.resolve()
    beside = (folder / name).resolve()
    if not beside.is_relative_to(folder):
        raise ProfileError(f'{path}: {key}: value "{value}": a file inside {path.parent}')
    return beside
