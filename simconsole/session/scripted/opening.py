"""Opens the drive of a scenario: its session without a bundle, with the scenario's own inputs in their places."""

import tempfile
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

import msgspec

from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.transport.message_files import load_registry
from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.drivers.scripted_controller import ScriptedCommands
from simconsole.processes.lifetimes import Interrupt
from simconsole.profiles.bridge import BridgeProfile
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.session.headless import open_headless
from simconsole.session.preconditions import check_controller
from simconsole.session.recorder import NoLog
from simconsole.session.resolution import headless
from simconsole.session.scripted.actors import ScriptedActors
from simconsole.session.scripted.events import ScriptedMessages, Standing, TriggeredEvents, check_messages
from simconsole.session.traffic_source import TrafficSource, ego_box
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession
from simconsole.tick.loop import Components, Recorder
from simconsole.values.errors import ProfileError, one_line
from simconsole.values.protocols import CommandSource, NobodyCommands, Output
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world
from simconsole.world.roads.road_world import roads_of
from simconsole.world.rules.owing import Owing

_BY_HAND = ("sdl", "keyboard")
"""Drivers that a scenario has not: without a script nobody sits in the seat."""


class OpenedScenario(NamedTuple):
    """The parts of a scenario's drive."""

    components: Components
    finished: Callable[[Snapshot], bool]
    problem: Callable[[], str | None]
    """What went wrong with the inputs themselves, once it is driven."""


def open_scenario(
    scenario: ScenarioProfile, resolved: ResolvedSession, console: Console, recorder: Recorder, stack: ExitStack
) -> OpenedScenario:
    """Open the drive of a scenario, whose session is as of `as_driven`; `stack` closes it.

    Raises:
        SimConsoleError: its parts do not fit together, or a device, port or file cannot be opened.
    """
    script = _Script(scenario, resolved, console)
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="simconsole-")))
    opened = open_headless(
        script.resolved, console, NoLog(), folder, Interrupt(), stack, scripted=script.into, others=script.others
    )
    # Who is asked for nothing is left out of the loop, and in a check, unlike in a drive, a failing recorder raises.
    components = opened.components._replace(recorder=recorder, latencies=None)

    def finished(snapshot: Snapshot) -> bool:
        return opened.left() or opened.finished(snapshot) or script.stands(snapshot)

    def problem() -> str | None:
        failure = opened.failure()
        return script.problem() if failure is None else one_line(failure)

    return OpenedScenario(components, finished, problem)


def as_driven(scenario: ScenarioProfile, resolved: ResolvedSession) -> ResolvedSession:
    """Return the scenario's session as it is opened: headless, and with nobody where its script drives.

    Raises:
        ProfileError: it has both a script and another driver, both traffic and actors, several platforms, or a
            controller by name that is not in lockstep.
    """
    check_alone(scenario, resolved)
    session = headless(resolved.session)
    driver = session.devices.driver
    if scenario.script is not None and driver not in ("none", *_BY_HAND):
        raise ProfileError(f"{scenario.title}: session.devices.driver: value {driver}: none, beside a script")
    if scenario.script is not None or driver in _BY_HAND:
        session = msgspec.structs.replace(session, devices=msgspec.structs.replace(session.devices, driver="none"))
    if scenario.actors and session.environment.traffic is not None:
        raise ProfileError(f"{scenario.title}: actors: without session.environment.traffic: one of the two")
    if scenario.remote and session.mode.pacing == "lockstep":
        raise ProfileError(f"{scenario.title}: remote: without a session in lockstep: one controller at a time")
    check_controller(session)
    check_messages(scenario.messages, bool(scenario.remote) or session.mode.pacing == "lockstep", scenario.title)
    return msgspec.structs.replace(resolved, session=session)


def check_alone(scenario: ScenarioProfile, resolved: ResolvedSession) -> None:
    """Refuse a session of several platforms.

    Raises:
        ProfileError: it has some.
    """
    if resolved.session.scenario.platforms:
        raise ProfileError(f"{scenario.title}: session.scenario.platforms: value given: a scenario drives one vehicle")


class _Script:
    """The scenario's own inputs, put into the parts of a drive."""

    def __init__(self, scenario: ScenarioProfile, resolved: ResolvedSession, console: Console) -> None:
        self.resolved = resolved
        self._scenario, self._console = scenario, console
        self._standing = Standing()
        self._messages: ScriptedMessages | None = None
        self._actors: ScriptedActors | None = None
        self.others: TrafficSource | None = None
        if scenario.actors:
            self._actors, self.others = self._road_users()

    def into(self, parts: Components) -> Components:
        """Return the parts with the scenario's devices, commands, edges and road users."""
        scenario, tick_hz = self._scenario, self._console.tick_hz
        outputs: tuple[Output, ...] = tuple(parts.outputs)
        devices, ecu = parts.devices, parts.ecu
        if scenario.script is not None:
            settings = cockpit_settings(self.resolved.cockpit, tick_hz)
            devices = ScriptSource(scenario.script, settings, tick_hz=tick_hz)
        if scenario.ecu or scenario.ecu_events:
            ecu = ScriptedCommands(scenario.ecu, scenario.ecu_events, tick_hz)
        commands, seen = self._commands(parts.commands)
        first: tuple[Output, ...] = () if self._actors is None else (self._actors,)  # acts begin before it is stepped
        outputs = (*first, *outputs, *seen)
        live = self.resolved.session.mode.pacing == "lockstep"  # its sockets are served meanwhile
        standby = (*(parts.standby if live else ()), self._standing.stand)
        return parts._replace(devices=devices, commands=commands, ecu=ecu, outputs=outputs, standby=standby)

    def stands(self, snapshot: Snapshot) -> bool:
        """Return whether simulated time stands for ever."""
        return self._standing.ends(snapshot)

    def problem(self) -> str | None:
        """Return what the console refused of the scenario's messages, or that simulated time stood for ever."""
        refused = None if self._messages is None else self._messages.refused
        return refused or self._standing.problem()

    def _commands(self, others: CommandSource) -> tuple[CommandSource, tuple[Output, ...]]:
        """Return where commands and edges come from, and what must see each tick for it."""
        scenario, tick_hz = self._scenario, self._console.tick_hz
        seen: tuple[Output, ...] = ()
        plain = all(step.at_s is not None and step.event not in ("pause", "start") for step in scenario.events)
        if scenario.messages:
            bridge = self.resolved.session.outputs.bridge or BridgeProfile()
            self._messages = ScriptedMessages(scenario.messages, ConsoleBridge(bridge, load_registry(bridge)), tick_hz)
            others, seen = self._messages, (self._messages,)
        elif isinstance(others, NobodyCommands):
            others = ScriptedCommands(scenario.remote, scenario.events if plain else (), tick_hz)
            if plain:
                return others, ()
        if not scenario.events:
            return others, seen
        events = TriggeredEvents(scenario.events, others, tick_hz)
        return events, (*seen, events)

    def _road_users(self) -> tuple[ScriptedActors, TrafficSource]:
        platform, tick_hz = self._console.platform, self._console.tick_hz
        world = None if self.resolved.world is None else open_world(self.resolved.world)
        route = None if world is None else world.route
        ego = ego_box(platform.initial_vehicle, platform)
        actors = ScriptedActors(self._scenario.actors, ego, route, tick_hz, self._scenario.title)
        roads = None if world is None else roads_of(world)
        owing = None
        if roads is not None and route is not None:
            owing = Owing(roads.road_map, roads.legs, route, tick_hz)
        return actors, TrafficSource(actors, platform, actors.period_ticks, route, owing)
