"""Where the processor time of a headless tick goes: script, controller, stages, vehicle, log.

Run: python benchmarks/tick_profile.py [--seconds S] [--rounds N] [--markdown] [--whole]

The drive is the scenario hand_over, recorded as `simconsole drive` records it. Each part is also run alone, with the
inputs of that drive. Every figure is the least of the rounds, in us of processor time a tick, once with one tick a call
and once in blocks (`tick/foresight.py`). Without the vehicle means its step over 0 ms in the place of 4.
"""

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from headless_drive import header

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.drivers.scripted_controller import ScriptedCommands
from simconsole.recording.bundles.log import LogWriter
from simconsole.session.pacing import UnpacedPacer
from simconsole.session.recorder import LogRecorder
from simconsole.session.resolution import load_scenario, resolve
from simconsole.tick import advance
from simconsole.tick.advance import Console
from simconsole.tick.assembly import assemble
from simconsole.tick.loop import Components, run
from simconsole.values.host.jit import compiled
from simconsole.values.state_vector import INPUT_WIDTH, LAYOUT, Snapshot

BLOCK = 64


class EachTick:
    """A pace that lets no tick be left out."""

    def wait(self) -> int:
        return 0


class Bench:
    """One scenario, ready to be driven again and again."""

    def __init__(self, seconds: float) -> None:
        self.scenario, _ = load_scenario("hand_over")
        resolved = resolve(self.scenario.session)
        self.console, self.start = assemble(resolved, compiled)
        self.cockpit = cockpit_settings(resolved.cockpit, self.console.tick_hz)
        self.ticks = round(seconds * self.console.tick_hz) // BLOCK * BLOCK

    def devices(self) -> ScriptSource:
        assert self.scenario.script is not None
        return ScriptSource(self.scenario.script, self.cockpit, tick_hz=self.console.tick_hz)

    def commands(self) -> ScriptedCommands:
        return ScriptedCommands(self.scenario.remote, self.scenario.events, self.console.tick_hz)

    def timed(self, call: Callable[[], object]) -> float:
        """Return the processor time (us) that a call takes, by the drive's ticks."""
        began = time.process_time_ns()
        call()
        return (time.process_time_ns() - began) / 1e3 / self.ticks

    def logged(self, call: Callable[[LogRecorder], object]) -> float:
        """As `timed`, with the recorder of a new log."""
        with (
            tempfile.TemporaryDirectory() as folder,
            LogWriter(Path(folder) / "drive.log", header(self.console.columns, self.console.tick_hz)) as log,
        ):
            return self.timed(lambda: call(LogRecorder(log)))

    def drive(self, console: Console, pace: Any) -> float:
        """Return the time of a tick of the whole drive."""
        return self.logged(
            lambda recorder: run(
                console, self.start, Components(self.devices(), self.commands(), recorder, (), pace), self.ticks
            )
        )

    def whole(self, pace: Any) -> tuple[float, float]:
        """Return the time of a tick of the whole drive, and of one without the vehicle."""
        return self.drive(self.console, pace), self.drive(self.console._replace(substeps=0), pace)


def parts(bench: Bench) -> dict[str, tuple[float, float]]:
    """Return the time of each part, with one tick a call and in blocks."""
    ticks, console, width = bench.ticks, bench.console, bench.console.width
    rows = np.zeros((ticks, width))
    for tick in range(0, ticks, BLOCK):
        bench.devices().foresee(tick + 1, rows[tick : tick + BLOCK, LAYOUT.sample.slice])
    inputs, samples, commands = rows[:, :INPUT_WIDTH].copy(), np.zeros((BLOCK, 14)), np.zeros((BLOCK, 17))

    def polled() -> None:
        devices = bench.devices()
        for tick in range(1, ticks + 1):
            devices.poll(tick)

    def taken() -> None:
        controller = bench.commands()
        for tick in range(1, ticks + 1):
            controller.take(tick)

    def foreseen(source: Any, into: Any) -> None:
        tick = 1
        while tick <= ticks:
            count = source.foresee(tick, into)
            if not count:
                source.take(tick)
            tick += max(1, count)

    def stages(of: Console) -> None:
        row = bench.start.vector
        for at in range(ticks):
            row = advance.advance_vector(row, inputs[at], of)

    def blocks(of: Console) -> None:
        row = bench.start.vector
        for at in range(0, ticks, BLOCK):
            advance.advance_block(row, rows[at : at + BLOCK], of)
            row = rows[at + BLOCK - 1].copy()

    def written(recorder: LogRecorder) -> None:
        for at in range(ticks):
            recorder.write(Snapshot(at + 1, console.tick_hz, rows[at]))

    def written_blocks(recorder: LogRecorder) -> None:
        for at in range(0, ticks, BLOCK):
            recorder.write_block(at + 1, rows[at : at + BLOCK])

    still = console._replace(substeps=0)
    return {
        "script": (bench.timed(polled), bench.timed(lambda: foreseen(bench.devices(), samples))),
        "controller": (bench.timed(taken), bench.timed(lambda: foreseen(bench.commands(), commands))),
        "stages, vehicle included": (bench.timed(lambda: stages(console)), bench.timed(lambda: blocks(console))),
        "stages, without the vehicle": (bench.timed(lambda: stages(still)), bench.timed(lambda: blocks(still))),
        "hash, frame and write": (bench.logged(written), bench.logged(written_blocks)),
    }


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=60.0, help="simulated seconds a round")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--markdown", action="store_true", help="the table of docs/tick.md")
    parser.add_argument("--whole", action="store_true", help="only the whole tick")
    given = parser.parse_args()
    bench = Bench(given.seconds)
    bench.whole(UnpacedPacer())  # compiles, loads, warms up
    found: dict[str, list[tuple[float, float]]] = {}
    for _ in range(given.rounds):
        singles = (0.0, 0.0) if given.whole else bench.whole(EachTick())
        blocks = bench.whole(UnpacedPacer())
        found.setdefault("whole tick", []).append((singles[0], blocks[0]))
        found.setdefault("whole tick, without the vehicle", []).append((singles[1], blocks[1]))
        for name, pair in ({} if given.whole else parts(bench)).items():
            found.setdefault(name, []).append(pair)
    row = "| {} | {:.2f} | {:.2f} |" if given.markdown else "{:32s} {:8.2f} {:8.2f}"
    if given.markdown:
        print("| us of CPU time a tick | one tick a call | in blocks |\n| --- | --- | --- |")
    for name, times in found.items():
        print(row.format(name, min(single for single, _ in times), min(block for _, block in times)))


if __name__ == "__main__":
    main()
