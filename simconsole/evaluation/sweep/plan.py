"""A sweep's plan as the tasks that it stands for: every source with every combination of values and every seed."""

import hashlib
import math
from collections.abc import Iterator, Sequence
from itertools import chain, product
from pathlib import Path
from typing import NamedTuple

import msgspec
import numpy as np

from simconsole.evaluation.metrics.registered import GROUP as METRICS
from simconsole.evaluation.sweep.scenario_values import of_scenario, with_scenario_values
from simconsole.evaluation.sweep.task import Task, to_bytes
from simconsole.profiles.files.loader import MAX_BYTES, read_text_of
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.profiles.strict_yaml import parse
from simconsole.profiles.sweep import MOST_DRIVES, Span, SweepProfile, Value
from simconsole.profiles.validation import PROFILE_FILES, convert
from simconsole.session.resolution import (
    headless,
    load_scenario,
    load_session,
    override,
    parted,
    resolve,
    with_named_values,
    with_session_values,
)
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError
from simconsole.values.registered import identities
from simconsole.values.version import __version__

LONGEST_S = 3600.0
"""Simulated time of a session's drive that nothing else ends."""


class Plan(NamedTuple):
    """All drives of a sweep, in order.

    Attributes:
        title: of the plan, or its file's name.
        keys: what is varied, in order; `source` stands before them.
        tasks: one for each drive.
        digest: of what is driven and by which version: results of another one are not mixed with these.
    """

    title: str
    keys: tuple[str, ...]
    tasks: tuple[Task, ...]
    digest: str


class _Source(NamedTuple):
    name: str
    resolved: ResolvedSession
    scenario: ScenarioProfile | None


def load_plan(path: Path) -> Plan:
    """Read a plan and make its tasks; every value of every drive is checked here, before anything is driven.

    Raises:
        ProfileError: plan, session, scenario or a value is missing or wrong; names file, key, value and range.
    """
    profile = convert(parse(read_text_of(path, MAX_BYTES), str(path)), SweepProfile, str(path))
    names = len(profile.sessions) + len(profile.scenarios)
    if not names:
        raise ProfileError(f"{path}: sessions: value missing: at least one session or scenario")
    axes = list(_axes(profile, path))
    if (count := names * math.prod(map(len, axes))) > MOST_DRIVES:
        raise ProfileError(f"{path}: values: {count} drives, at most {MOST_DRIVES}")
    tasks: list[Task] = []
    for source in _sources(profile, path):
        for combination in product(*axes):
            values = dict(chain.from_iterable(part.items() for part in combination))
            own, others = of_scenario(values)
            task = Task(
                index=len(tasks),
                source=source.name,
                values=values,
                resolved=_changed(source.resolved, others, str(path)),
                scenario=with_scenario_values(source.scenario, own, str(path)),
                timeout_s=profile.timeout_s,
            )
            tasks.append(task)
    keys = (*profile.values, *(() if profile.seeds is None else profile.seeds.of))
    return Plan(profile.title or path.stem, keys, tuple(tasks), _digest(tasks))


def _axes(profile: SweepProfile, path: Path) -> Iterator[list[dict[str, Value]]]:
    """Yield what is varied, one thing after the other: the values that each of its steps sets."""
    for key, values in profile.values.items():
        steps = _steps(values) if isinstance(values, Span) else values
        if not steps:
            raise ProfileError(f"{path}: values.{key}: value missing: at least one")
        yield [{key: value} for value in steps]
    seeds = profile.seeds
    if seeds is not None:
        yield [dict.fromkeys(seeds.of, seed) for seed in range(seeds.first, seeds.first + seeds.count)]


def _steps(span: Span) -> list[float]:
    """Return the values of a span, rounded to twelve digits as people would write them."""
    return [float(f"{value:.12g}") for value in np.linspace(span.first, span.last, span.count)]


def _sources(profile: SweepProfile, path: Path) -> Iterator[_Source]:
    for name in profile.sessions:
        session = headless(load_session(_beside(path, name)))
        longest_s = profile.duration_s or session.scenario.duration_s or LONGEST_S
        session = override(session, scenario={"duration_s": longest_s})
        yield _Source(Path(name).stem, resolve(session), None)
    for name in profile.scenarios:
        scenario, _ = load_scenario(_beside(path, name))
        yield _Source(Path(name).stem, resolve(scenario.session), scenario)


def _beside(path: Path, name: str) -> str:
    """Return a shipped profile's name as it is, and a file's seen from the plan's folder."""
    return str(path.parent / name) if name.endswith(PROFILE_FILES) else name


def _changed(resolved: ResolvedSession, values: dict[str, Value], origin: str) -> ResolvedSession:
    of_session, of_named = parted(values)
    session = with_session_values(resolved.session, of_session, origin)
    return with_named_values(msgspec.structs.replace(resolved, session=session), of_named, origin)


def _digest(tasks: Sequence[Task]) -> str:
    found = hashlib.sha256("\n".join((__version__, *identities(METRICS))).encode())
    for task in tasks:
        found.update(to_bytes(task))
    return found.hexdigest()
