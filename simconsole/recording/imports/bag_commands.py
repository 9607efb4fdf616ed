"""Recorded commands in place of a controller's: a bag plays into the ROS side's slot, checked like a live client.

Of a bag that counts simulated time, a message comes at its own time; of one with a wall clock's times, at that since
the bag's start. It counts as received after the last tick that is not later.
"""

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

import msgspec

from simconsole.bridge.console.command_decoder import BALL_SPEED, REQUEST
from simconsole.bridge.console.endpoint import ConsoleBridge
from simconsole.bridge.console.plan_input import ADVICE, PLAN
from simconsole.bridge.protocol.access import Role
from simconsole.profiles.bridge import BridgeProfile
from simconsole.recording.imports.bag import Bag, BagMessage, BagTopic
from simconsole.values.errors import RecordingError
from simconsole.values.signals import EventInput, RemoteCommand
from simconsole.values.state_vector import Snapshot

COMMANDS_PER_TICK: Final = 4.0
"""Commands that are taken for each tick at least: a recording is no flood."""
UNTYPICAL: Final = (REQUEST, BALL_SPEED)
"""Topics whose type says nothing: they are found by their names only."""
_SPECIFICATION: Final = re.compile(r"bag:(?P<path>.+?)(:(?P<topic>/[A-Za-z0-9_/]+))?")


class BagChoice(NamedTuple):
    """Which bag plays, and which of its topics; None for those that the console knows."""

    path: Path
    topic: str | None


def bag_choice(text: str) -> BagChoice:
    """Return what `bag:FILE` or `bag:FILE:/TOPIC` says.

    Raises:
        RecordingError: it is neither.
    """
    found = _SPECIFICATION.fullmatch(text)
    if found is None:
        raise RecordingError(f"commands: value {text!r}: bag:FILE or bag:FILE:/TOPIC")
    return BagChoice(Path(found["path"]), found["topic"])


class BagCommands:
    """A controller whose commands are recorded ones: a source of commands, and an output that sees the ticks.

    The messages that it plays are all read once before the first tick, so that a damaged bag ends no drive midway.
    """

    def __init__(self, choice: BagChoice, profile: BridgeProfile, tick_hz: int) -> None:
        """Open a bag and find its commands.

        Args:
            choice: the bag and its topic.
            profile: names of the console's topics, limits of commands.
            tick_hz: of the drive.

        Raises:
            RecordingError: no bag, damaged, or without commands that the console takes.
        """
        commands_hz = max(profile.limits.commands_hz, COMMANDS_PER_TICK * tick_hz)
        limits = msgspec.structs.replace(profile.limits, commands_hz=commands_hz)
        self._console = ConsoleBridge(msgspec.structs.replace(profile, limits=limits))
        router = self._console.router
        names = {here: standard for standard, here in self._console.names.items()}
        command_types = {
            name: topic.type
            for name, topic in router.topics.items()
            if topic.command is not None and names[name] not in (PLAN, ADVICE)  # which command nothing
        }
        standard = {names[name]: name for name in command_types}
        bag = Bag(choice.path, tuple(command_types.values()))
        self._topics = played_topics(bag, choice.topic, command_types, standard)
        for _ in bag.messages(tuple(self._topics)):
            pass
        self._session = router.connect("bag", role=Role.CONTROL)
        self._session.set_level("none")
        self._messages = bag.messages(tuple(self._topics))
        self._next = next(self._messages, None)
        self._counts = {"accepted": 0, "refused": 0}
        self._first_refusal = ""
        self._play(0)

    def publish(self, snapshot: Snapshot) -> None:
        """See a finished tick: what was recorded until then has come now."""
        self._console.inputs.tick = snapshot.tick
        self._console.keep_time(snapshot, snapshot.t_ns)
        self._play(snapshot.t_ns)

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command and all edges since the last call."""
        return self._console.inputs.take(tick)

    def close(self) -> None:
        """Close the bag."""
        self._messages.close()

    def summary(self) -> dict[str, Any]:
        """Return how many messages were played and refused, and why the first one was."""
        refusal = {"first_refusal": self._first_refusal} if self._first_refusal else {}
        return {"commands": {"topics": sorted(self._topics), **self._counts, **refusal}}

    def _play(self, now_ns: int) -> None:
        while self._next is not None and self._next.time_ns <= now_ns:
            self._receive(self._next, now_ns)
            self._next = next(self._messages, None)

    def _receive(self, message: BagMessage, now_ns: int) -> None:
        outcome = self._console.receive_plain(self._session, self._topics[message.topic], message.plain, now_ns)
        if outcome.kind == "command":
            self._counts["accepted"] += 1
            return
        self._counts["refused"] += 1
        self._first_refusal = self._first_refusal or f"{message.topic}: {outcome.text}"


def played_topics(
    bag: Bag, topic: str | None, command_types: Mapping[str, str], standard: Mapping[str, str]
) -> dict[str, str]:
    """Return which topics of a bag are played, each with the console's topic that it is for.

    A topic that is named is played alone. Otherwise those that have the console's own names and types, and where no
    command is among them the only one whose type is a command's.

    Args:
        bag: the bag.
        topic: the one that was asked for.
        command_types: full type names by the names of the console's command topics.
        standard: these names by standard name.

    Raises:
        RecordingError: none, or more than one of which it could be; names them.
    """
    by_type = {command_types[here]: here for name, here in standard.items() if name not in UNTYPICAL}
    if topic is not None:
        return {topic: _for_topic(bag, topic, command_types, by_type)}
    own = {found.name: found.name for found in bag.topics if command_types.get(found.name) == found.type}
    if any(command_types[name] in by_type for name in own):
        return own
    others = [found for found in bag.topics if found.type in by_type and found.messages]
    if len({found.name for found in others}) == 1:
        return {**own, others[0].name: by_type[others[0].type]}
    if not others and own:
        return own
    said = ", ".join(sorted({found.name for found in others})) or "none"
    wanted = "one topic of a command's type; say which: bag:FILE:/TOPIC" if others else ", ".join(sorted(by_type))
    raise RecordingError(f"{bag.path}: commands: value {said}: {wanted}")


def _for_topic(bag: Bag, topic: str, command_types: Mapping[str, str], by_type: Mapping[str, str]) -> str:
    found: BagTopic | None = next((one for one in bag.topics if one.name == topic), None)
    if found is None:
        names = ", ".join(sorted({one.name for one in bag.topics})[:50]) or "none"
        raise RecordingError(f"{bag.path}: topic: value {topic}: one of its topics: {names}")
    if command_types.get(topic) == found.type:
        return topic
    if found.type not in by_type:
        raise RecordingError(
            f"{bag.path}: topic {topic}: type: value {found.type}: one of {', '.join(sorted(by_type))}"
        )
    return by_type[found.type]
