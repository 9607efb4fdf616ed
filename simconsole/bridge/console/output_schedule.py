"""Which output topics are due in which tick, under the names and at the rates of a bridge's profile."""

from collections.abc import Callable
from typing import Any, Final

from simconsole.bridge.console.published_tick import ONCE, OutputTopic, PublishedTick
from simconsole.bridge.console.topics import GLOBAL_TOPICS, ODOMETRY, is_due
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError
from simconsole.values.state_vector import Snapshot

_OFTEN_TICKS: Final = 16


class ScheduledOutput:
    """One output topic at work."""

    def __init__(self, output: OutputTopic, name: str, rate_hz: float) -> None:
        self.standard = output.name
        self.name = name
        self.type = output.type
        self.watched = output.watched
        self.measured = output.measured
        self.shared = output.shared
        self.latched = output.rate_hz == ONCE or output.watched is not None
        self.rate_hz = rate_hz
        self.build: Callable[[PublishedTick], Any] = output.build


class OutputSchedule:
    """The output topics that a profile wants. A bridge asks it which of them to send, an export which to write."""

    def __init__(self, outputs: tuple[OutputTopic, ...], names: dict[str, str], profile: BridgeProfile) -> None:
        """Take the table of outputs and what its standard names are called (`topic_names`).

        Raises:
            ProfileError: the profile rates a topic that does not exist.
        """
        _check_known("rates_hz", profile.rates_hz, [output.name for output in outputs])
        rated = [(output, profile.rates_hz.get(output.name, output.rate_hz)) for output in outputs]
        self.outputs = tuple(ScheduledOutput(output, names[output.name], rate) for output, rate in rated if rate)
        self._rates_hz = tuple({output.rate_hz for output in self.outputs})
        self._watched = tuple({output.watched for output in self.outputs if output.watched is not None})
        self._seen: list[float | None] = [None] * len(self._watched)
        self._unchanged = (False,) * len(self._watched)
        self._together: dict[tuple[bool, tuple[bool, ...], tuple[bool, ...]], tuple[ScheduledOutput, ...]] = {}
        """The topics that are due by these rates and changes, found once: a drive has a handful of such sets."""
        self._last_tick: int | None = None  # that was asked about
        self._repeats = all(rate_hz % 1.0 == 0.0 for rate_hz in self._rates_hz)  # what is due, each second
        self._due_rates: dict[tuple[int, int], tuple[bool, ...]] = {}
        """Which rates are due, by a tick's place in its second and how many ticks after the one before it comes."""

    def due(self, snapshot: Snapshot, *, odometry: bool = False) -> tuple[ScheduledOutput, ...]:
        """Return the topics that are due in this tick, in the table's order; with `odometry`, that in any case."""
        tick, last, tick_hz = snapshot.tick, self._last_tick, snapshot.tick_hz
        self._last_tick = tick
        rates = self._rates_due(tick, last, tick_hz)
        values: list[float | None] = [float(snapshot.vector[column]) for column in self._watched]
        changes = self._unchanged
        if values != self._seen:
            changes = tuple(now != before for now, before in zip(values, self._seen, strict=True))
            self._seen = values
        which = (odometry, rates, changes)
        found = self._together.get(which)
        if found is None:
            found = self._together[which] = self._due_by(odometry, rates, changes)
        return found

    def _rates_due(self, tick: int, last: int | None, tick_hz: int) -> tuple[bool, ...]:
        """Return which rates are due in a tick; of ticks that come as often as before this is looked up."""
        repeats = self._repeats and last is not None and 0 < tick - last < _OFTEN_TICKS
        key = (tick % tick_hz, tick - (last or 0))
        found = self._due_rates.get(key) if repeats else None
        if found is None:
            found = tuple(is_due(tick, last, tick_hz, rate_hz) for rate_hz in self._rates_hz)
            if repeats:
                self._due_rates[key] = found
        return found

    def _due_by(
        self, odometry: bool, rates: tuple[bool, ...], changes: tuple[bool, ...]
    ) -> tuple[ScheduledOutput, ...]:
        """Return the topics that are due if these of the rates are, and these of the watched columns have changed."""
        rates_hz = {rate_hz for rate_hz, due in zip(self._rates_hz, rates, strict=True) if due}
        changed = {column for column, due in zip(self._watched, changes, strict=True) if due}
        return tuple(
            output
            for output in self.outputs
            if output.rate_hz in rates_hz or output.watched in changed or (odometry and output.standard == ODOMETRY)
        )


def topic_names(profile: BridgeProfile, standard: list[str]) -> dict[str, str]:
    """Return what each standard name is called under a profile's namespace and renames.

    Raises:
        ProfileError: the profile renames a topic that does not exist, or gives two topics one name.
    """
    _check_known("rename", profile.rename, standard)
    names = {
        name: profile.rename.get(name) or (name if name in GLOBAL_TOPICS else profile.namespace + name)
        for name in standard
    }
    seen: dict[str, str] = {}
    for name, here in names.items():
        if here in seen:
            raise ProfileError(f"outputs.bridge.rename: {name} and {seen[here]} would both be {here}")
        seen[here] = name
    return names


def _check_known(key: str, given: dict[str, Any], known: list[str]) -> None:
    for name in given:
        if name not in known:
            raise ProfileError(f"outputs.bridge.{key}: {name} is no topic of the console, only {', '.join(known)}")
