"""A scenario driven into memory: for tests that look at rows."""

from simconsole.evaluation.checks import scenario_check as checking
from simconsole.evaluation.checks.memory_recorder import MemoryRecorder
from simconsole.profiles.scenario import ScenarioProfile
from simconsole.tick.advance import Console


def drive_scenario(scenario: ScenarioProfile) -> tuple[MemoryRecorder, tuple[str, ...]]:
    """Drive it and return its rows and their columns."""
    names: tuple[str, ...] = ()

    def recorder_of(console: Console) -> MemoryRecorder:
        nonlocal names
        names = console.columns
        return MemoryRecorder(round(scenario.duration_s * console.tick_hz), console.width)

    return checking.drive_scenario(scenario, recorder_of), names
