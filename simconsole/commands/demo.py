"""`simconsole demo`: the whole way from the wheel to the report, on a machine with nothing but Python."""

import time
from argparse import Namespace
from pathlib import Path
from typing import Any

from simconsole.commands.outcome import Outcome, table
from simconsole.commands.progress import Progress
from simconsole.exports import REPORT, SCENE, write_exports
from simconsole.session import drive
from simconsole.session_files import load_session, override, resolve


def demo(words: Namespace) -> Outcome:
    """Drive the demo session, write report and scene, and print what came of it."""
    session = load_session("demo")
    if words.realtime:
        session = override(session, mode={"pacing": "realtime"})
    resolved = resolve(session)
    folder = Path(words.out) if words.out else Path("out") / time.strftime("demo-%Y%m%d-%H%M%S")
    length_m = 0.0 if resolved.world is None else resolved.world.length_m
    with Progress("driving", length_m) as progress:
        result = drive(resolved, folder, progress.watch)
    with Progress("writing report and scene"):
        metrics = write_exports(folder)
    results = {"bundle": str(folder), "digest": result.digest, **metrics, **result.summary}
    return Outcome(0, results, summary_text(folder, metrics, result.summary))


def summary_text(folder: Path, metrics: dict[str, Any], summary: dict[str, Any]) -> str:
    """Return the short table at the end of a drive."""
    rows = [
        ("distance", f"{metrics['distance_m']:.1f} m"),
        ("duration", f"{metrics['duration_s']:.1f} s simulated"),
    ]
    part = metrics["autonomous"]
    if part:
        rows.append(("by the autopilot", f"{part['distance_m']:.1f} m at {part['mean_speed_kmh']:.1f} km/h on average"))
    if part and part["lateral_rms_m"] is not None:
        rms, largest = part["lateral_rms_m"] * 100.0, part["lateral_max_m"] * 100.0
        rows.append(
            ("lateral error", f"RMS {rms:.2f} cm, max {largest:.2f} cm (base_link against the theoretical path)")
        )
    rows += [(f"mode at {c['t_s']:7.2f} s", f"{c['mode']} ({c['reason']})") for c in metrics["mode_changes"]]
    rows += [
        ("tick lateness", summary["lateness"]),
        ("real-time factor", f"{summary['real_time_factor']:.1f}"),
        ("bundle", str(folder)),
        ("report", str(folder / REPORT)),
        ("scene", str(folder / SCENE)),
    ]
    return table(rows)
