"""The paired report of a drive and its counterfactual, in the bundle of the latter."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from simconsole.evaluation.counterfactual.drive_again import OPEN_LOOP, Again
from simconsole.evaluation.metrics.table import recorded_drive
from simconsole.evaluation.report.paired_page import Side, separation_m, write_paired_report
from simconsole.recording.bundles.bundle import add_export, open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.world.kinds.worlds import open_world

PAIR: Final = "pair.html"


def write_pair(folder: Path, again: Again, values: Mapping[str, object]) -> dict[str, Any]:
    """Write the paired report of the drive in `folder` and `again`; return both metrics and how far they came apart.

    Raises:
        RecordingError: one of them is no bundle, or the page cannot be written.
    """
    changes = ", ".join(f"{key} = {value}" for key, value in values.items())
    sides = _side("recorded", folder), _side(changes, again.folder)
    notes = [f"Driver: {OPEN_LOOP}."]
    if not again.unchanged.equal:
        notes.append("This version makes the unchanged drive differently, too: not every difference is of the change.")
    title = f"{folder.resolve().name} with {changes}"
    found = write_paired_report(again.folder / PAIR, title, notes, sides, again.changed.differences)
    add_export(again.folder, PAIR)
    apart = separation_m(sides[0].drive, sides[1].drive)
    return {"metrics": [*found.values()], "apart_max_m": float(apart.max()), "apart_end_m": float(apart[-1])}


def _side(name: str, folder: Path) -> Side:
    bundle = open_bundle(folder)
    world = recorded_session(bundle).world
    return Side(name, recorded_drive(bundle.log), None if world is None else open_world(world).route)
