"""Scenarios as text, driven into memory."""

from typing import NamedTuple

import numpy as np

from simconsole.evaluation.checks import scenario_check
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.profiles.files.loader import parse
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.tick.advance import Console
from simconsole.values.signals import Event

HEAD = """\
schema: 1
title: a test
duration_s: {seconds}
session:
  schema: 1
  scenario: {{vehicle: hatchback}}
  features: {{control: {{person_required: false}}}}
  devices: {{driver: none}}
"""
ENGAGED = """\
remote:
  - {start_s: 0.1, end_s: 60, kind: speed, speed_mps: 8}
"""
ASKS = "  - {event: request_autonomous, at_s: 0.5}\n"


class Driven(NamedTuple):
    """A drive in memory."""

    rows: np.ndarray
    columns: tuple[str, ...]
    problems: list[str]
    digest: bytes

    def column(self, name: str) -> np.ndarray:
        found: np.ndarray = self.rows[:, self.columns.index(name)]
        return found

    def ticks_of(self, event: Event) -> list[int]:
        """In which ticks an edge came."""
        return (np.flatnonzero(self.column("events.events").astype(int) & int(event)) + 1).tolist()


def scenario(text: str, seconds: float = 8) -> ScenarioProfile:
    return parse(HEAD.format(seconds=seconds) + text, ScenarioProfile, "a test.yaml")


def driven(text: str, seconds: float = 8) -> Driven:
    columns: list[str] = []
    problems: list[str] = []

    def recorder_of(console: Console) -> MemoryRecorder:
        columns.extend(console.columns)
        return MemoryRecorder(round(seconds * console.tick_hz), console.width)

    kept = scenario_check.drive_scenario(scenario(text, seconds), recorder_of, told=problems.append)
    return Driven(kept.vectors, tuple(columns), problems, kept.digest)
