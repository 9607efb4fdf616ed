"""What `simconsole drive` offers when its cockpit is not there: a page in a window, or in the terminal."""

import sys
from typing import Final, NamedTuple

import msgspec

from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.hud.start_page import Offer, StartPage, opened
from simconsole.hud.window.sdl_display import has_display
from simconsole.hud.window.start_window import choose
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load, names
from simconsole.profiles.files.titles import shipped
from simconsole.profiles.files.world_files import load_world
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.view import HudProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.session.resolution import override, resolve
from simconsole.values.errors import DeviceError, DeviceNotFound, WorkerError

KEYBOARD: Final = "keyboard"
VIRTUAL: Final = "virtual"


class Offered(NamedTuple):
    """A page, and what its lines stand for."""

    page: StartPage
    cockpits: tuple[str, ...]  # names of cockpit profiles; `virtual` the simulated person
    places: tuple[str, ...]  # names of worlds; empty: that of the session


def somebody_can_be_asked() -> bool:
    """Return whether there is a display or a terminal."""
    return has_display() or (sys.stdin.isatty() and sys.stderr.isatty())


def offered(session: SessionProfile, message: str) -> Offered:
    """Look what is connected; return what can be driven.

    Args:
        session: What was to be driven.
        message: Why a person is asked.
    """
    sees = has_display() and session.outputs.hud is not None
    cockpits, lines = [], []
    for name in names("devices"):
        profile = load("devices", name, CockpitProfile)
        if name == KEYBOARD:
            note = "steering assistance; E: automatic drive, Q: back; F1: all keys" if sees else "needs a display"
            line = Offer(profile.title, note, sees)
        else:
            line = _connected(profile)
        cockpits.append(name)
        lines.append(line)
    order = sorted(range(len(lines)), key=lambda at: (not lines[at].possible, cockpits[at] == KEYBOARD))
    watched = Offer("Nobody: a simulated person", "a virtual wheel; you watch")
    worlds = {name: load_world(name) for name in shipped("worlds")}
    indoors = isinstance(resolve(session).vehicle, TurtlebotProfile)  # a car does not fit into a robots' arena
    places = ["", *(name for name, world in worlds.items() if isinstance(world, ArenaProfile) is indoors)]
    own = session.environment.world
    shown = [Offer(f"as in {session.title or 'the session'}", "" if own is None else str(own).rsplit("/", 1)[-1])]
    shown += [Offer(worlds[name].title or name, name) for name in places[1:]]
    page = opened([*(lines[at] for at in order), watched], shown, message)
    return Offered(page, (*(cockpits[at] for at in order), VIRTUAL), tuple(places))


def ask(session: SessionProfile, message: str) -> SessionProfile | None:
    """Return `session` as a person wants to drive it, None if not at all.

    Args:
        session: What was to be driven.
        message: Why a person is asked.
    """
    found = offered(session, message)
    try:
        page = choose(found.page, session.outputs.hud or HudProfile()) if has_display() else None
        left = page is None and has_display()
    except WorkerError as problem:
        _say(str(problem))
        page, left = None, False
    if left:
        return None
    if page is None:
        page = _in_terminal(found.page)
    return None if page is None else chosen(session, found.cockpits[page.cockpit], found.places[page.place])


def chosen(session: SessionProfile, cockpit: str, world: str) -> SessionProfile:
    """Return `session` with another cockpit (or `virtual`) and, unless it is empty, another world."""
    if world:
        session = override(session, environment={"world": world})
    if cockpit == VIRTUAL:
        return override(session, devices={"driver": VIRTUAL, "person": None})
    driver = KEYBOARD if cockpit == KEYBOARD else "sdl"
    session = override(session, devices={"driver": driver, "cockpit": cockpit, "person": None})
    if cockpit != KEYBOARD:
        return session
    control = msgspec.to_builtins(session.features.control)
    return override(session, features={"control": {**control, "manual_automatic": True}})


def _connected(profile: CockpitProfile) -> Offer:
    try:
        SdlSource(profile).close()
    except DeviceNotFound:
        return Offer(profile.title, "not connected", possible=False)
    except DeviceError as problem:
        return Offer(profile.title, str(problem), possible=False)
    return Offer(profile.title, "connected")


def _in_terminal(page: StartPage) -> StartPage | None:
    """Ask for two numbers; anything else, or the end of input, is a no."""
    _say(page.message)
    cockpit = _number("drive with", page.cockpits, page.cockpit)
    place = None if cockpit is None else _number("where", page.places, page.place)
    if cockpit is None or place is None:
        return None
    return page._replace(cockpit=cockpit, place=place)


def _number(question: str, offers: tuple[Offer, ...], first: int) -> int | None:
    for number, offer in enumerate(offers, start=1):
        note = f" ({offer.note})" if offer.note else ""
        _say(f"  {number if offer.possible else '-':>2}  {offer.label}{note}")
    print(f"{question} [{first + 1}; q leaves]: ", end="", file=sys.stderr, flush=True)
    answer = sys.stdin.readline()
    words = answer.strip()
    if answer.endswith("\n") and not words:
        return first
    number = int(words) - 1 if words.isdecimal() else -1
    return number if 0 <= number < len(offers) and offers[number].possible else None


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
