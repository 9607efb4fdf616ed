"""The end of `simconsole demo` and `simconsole drive`: report and scene beside the bundle, the table, the exit code."""

from typing import Any

from simconsole.commands.outcome import Outcome, table
from simconsole.commands.progress import Progress
from simconsole.exports import REPORT, SCENE, write_exports
from simconsole.lifetimes import INTERRUPTED
from simconsole.session import DriveResult


def finish(result: DriveResult, report: bool = True, scene: bool = True) -> Outcome:
    """Write what is wanted beside the bundle; code 130 if the drive was interrupted, its bundle whole all the same.

    Raises:
        StationError: the scene's process failed.
    """
    code = INTERRUPTED if result.interrupted else 0
    results: dict[str, Any] = {"bundle": str(result.folder), "digest": result.digest, **result.summary}
    if not result.ticks:
        return Outcome(code, results, f"{result.folder}: interrupted before the first tick")
    with Progress("writing report and scene" + (" (Ctrl-C: not now)" if result.interrupted else "")):
        metrics = write_exports(result.folder, report=report, scene=scene)
    rows = _rows(result, metrics)
    rows += [("report", str(result.folder / REPORT))] * report + [("scene", str(result.folder / SCENE))] * scene
    return Outcome(code, {**results, **metrics}, table(rows))


def _rows(result: DriveResult, metrics: dict[str, Any]) -> list[tuple[str, str]]:
    interrupted = ", interrupted" if result.interrupted else ""
    rows = [
        ("distance", f"{metrics['distance_m']:.1f} m"),
        ("duration", f"{metrics['duration_s']:.1f} s simulated{interrupted}"),
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
        ("tick lateness", result.summary["lateness"]),
        ("real-time factor", f"{result.summary['real_time_factor']:.1f}"),
        ("bundle", str(result.folder)),
    ]
    if result.recording_failure is not None:
        rows.append(("RECORDING FAILED", result.recording_failure))
    return rows
