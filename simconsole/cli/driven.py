"""The end of `simconsole demo` and `simconsole drive`: packing, report and scene, the table, the exit code."""

from collections import Counter
from pathlib import Path
from typing import Any

from simconsole.cli.outcome import RECORDING_FAILED, Outcome, table
from simconsole.cli.progress import Progress
from simconsole.cli.terminal.talk import say
from simconsole.evaluation.metrics.rule_metrics import RULES
from simconsole.evaluation.report.exports import REPORT, write_exports
from simconsole.evaluation.report.scene_export import SCENE
from simconsole.processes.lifetimes import INTERRUPTED
from simconsole.profiles.link import link_label
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.pack import Sizes, pack
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.session.lifecycle import DriveResult
from simconsole.values.errors import one_line


def finish(result: DriveResult, report: bool = True, scene: bool = True, packed: bool = True) -> Outcome:
    """Write what is wanted beside the bundle, and pack it; the drive's own result does not depend on whether that went.

    The code is 1 if the recording failed, or the controller that the session names, and 130 if the drive was
    interrupted (its bundle is complete all the same).
    """
    ended = [] if result.failure is None else [("ended by", one_line(result.failure))]
    code = 1 if ended or result.recording_failure is not None else INTERRUPTED if result.interrupted else 0
    results: dict[str, Any] = {
        "bundle": str(result.folder),
        "digest": result.digest,
        **result.summary,
        "recording_failure": result.recording_failure,
        "failure": ended[0][1] if ended else None,
        "exports_failure": None,
        "packing_failure": None,
    }
    failed = [] if result.recording_failure is None else [(RECORDING_FAILED, result.recording_failure)]
    if failed and (report or scene):  # a disk that takes no log takes no export: rerun would wait for long
        report, scene, results["exports_failure"] = False, False, "not tried, for the recording failed"
    if not result.ticks:
        return Outcome(code, results, table([("bundle", f"{result.folder}: no tick was recorded"), *ended, *failed]))
    if result.interrupted:
        say(_rest(result.folder, packed and not failed, report, scene))
    # Packed first: what reads a few columns of a long drive is then done in seconds, not minutes.
    of_packing = _pack(result, results) if packed and not failed else []
    rows = _export(result, report, scene, results)
    return Outcome(code, results, table(rows + of_packing + ended + failed))


def _export(result: DriveResult, report: bool, scene: bool, results: dict[str, Any]) -> list[tuple[str, str]]:
    """Write report and scene; return rows for a person, and add to `results` what came of it."""
    try:
        with Progress("writing report and scene" + _patience(result)) as progress:
            metrics = write_exports(result.folder, report=report, scene=scene, told=progress.done)
    except Exception as error:  # noqa: BLE001  too little memory shows in many ways, and the drive is in its bundle
        results["exports_failure"] = said = one_line(error)
        return [*_driven_rows(result), ("report and scene", f"not written: {said}")]
    results.update(metrics)
    rows = _rows(result, metrics, _link(result))
    rows += [("report", str(result.folder / REPORT))] * report + [("scene", str(result.folder / SCENE))] * scene
    return rows


def _pack(result: DriveResult, results: dict[str, Any]) -> list[tuple[str, str]]:
    """Pack the bundle; return rows for a person, and add to `results` why it stays as it is, if so."""
    try:
        with Progress("packing" + _patience(result)) as progress:
            sizes = pack(result.folder, progress.done)
            for name in result.platforms:
                more = pack(result.folder / name, progress.done)
                sizes = Sizes(sizes.log_bytes + more.log_bytes, sizes.packed_bytes + more.packed_bytes)
    except Exception as error:  # noqa: BLE001  as above: the log stays
        results["packing_failure"] = said = one_line(error)
        return [("packed", f"no: {said}")]
    return [("packed", f"{sizes.packed_bytes / 1e6:.1f} MB, of a log of {sizes.log_bytes / 1e6:.1f} MB")]


def _rest(folder: Path, packed: bool, report: bool, scene: bool) -> str:
    """Return what is still to be done after Ctrl-C, and how to be without it."""
    steps = [("packing it (--no-pack)", packed), ("writing the report (outputs.report: false)", report)]
    steps.append(("writing the scene (outputs.scene: null)", scene))
    wanted = " and ".join(step for step, is_wanted in steps if is_wanted)
    return f"the drive has ended and is whole in {folder}" + (f"; now {wanted}" if wanted else "")


def _patience(result: DriveResult) -> str:
    return " (Ctrl-C: not now)" if result.interrupted else ""


def _driven_rows(result: DriveResult) -> list[tuple[str, str]]:
    ended = result.summary.get("ended")
    return [
        *([] if ended is None else [("ended", ended)]),
        ("tick lateness", result.summary["lateness"]),
        ("real-time factor", f"{result.summary['real_time_factor']:.1f}"),
        ("bundle", str(result.folder)),
    ]


def _link(result: DriveResult) -> str:
    """Return what the autopilot's odometry and link were like."""
    from simconsole.bridge.console.topics import ODOMETRY, ODOMETRY_HZ

    session = recorded_session(open_bundle(result.folder)).session
    bridge, mode = session.outputs.bridge, session.mode
    if bridge is None:
        return ""
    odometry_hz = mode.control_hz if mode.pacing == "lockstep" else bridge.rates_hz.get(ODOMETRY, ODOMETRY_HZ)
    return f"{link_label(bridge.link)}, at {odometry_hz:g} Hz"


def _road_rows(metrics: dict[str, Any]) -> list[tuple[str, str]]:
    """Return what was met on a road map, and which rules were broken there."""
    if metrics["road"] is None:
        return []
    met, broken = metrics["road"]["whole"], Counter(RULES[event["rule"]] for event in metrics["rules"])
    return [
        ("lights", f"{met['lights_passed']} passed, stood at {met['lights_stood_at']} of them"),
        ("others", f"somebody had to be let pass {met['let_pass']} times"),
        ("rules", ", ".join(f"{rule}: {count}" for rule, count in broken.items()) or "none broken, nobody touched"),
    ]


def _rows(result: DriveResult, metrics: dict[str, Any], link: str) -> list[tuple[str, str]]:
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
        rows.append(("autopilot's link", link))
    manual = metrics["manual"]
    if manual and manual["lateral_deviation_m"] is not None:
        rms, spread, largest = (100.0 * manual[f"lateral_{key}_m"] for key in ("rms", "deviation", "max"))
        shown = (
            f"{manual['distance_m']:.1f} m, lateral error RMS {rms:.1f} cm, max {largest:.1f} cm, SD {spread:.1f} cm"
        )
        rows.append(("by the person", shown))
    rows += _road_rows(metrics)
    wheel = metrics["force_feedback"]
    if wheel and wheel["eased_from_s"] is not None:
        least = f"{100.0 * wheel['least_share']:.0f} % of the car's torque at {wheel['least_at_kmh']:.0f} km/h"
        rows.append(("force feedback", f"eased to {least}, {wheel['eased_s']:.1f} s in all"))
    rows += [(f"mode at {c['t_s']:7.2f} s", f"{c['mode']} ({c['reason']})") for c in metrics["mode_changes"]]
    return rows + _driven_rows(result)
