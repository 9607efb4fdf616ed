"""What is made from a bundle afterwards: report.html and scene.rrd. Nothing a replay needs."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Final

from simconsole.processes.lifetimes import remove_half_made, undone
from simconsole.profiles.faults import fault_label
from simconsole.recording.bundles.bundle import add_export, open_bundle
from simconsole.recording.bundles.manifest import Manifest, refuse_signed
from simconsole.recording.bundles.provenance import facts as provenance_facts
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.recording.reading import LogTable
from simconsole.session.scene_job import LIVE_SCENE, scene_job
from simconsole.tick.assembly import ResolvedSession
from simconsole.world.course import Course

REPORT: Final = "report.html"
SCENE: Final = "scene.rrd"


def write_exports(folder: Path, report: bool = True, scene: bool = True) -> dict[str, Any]:
    """Write report and scene of the bundle in `folder`, each where wanted; return the report's metrics.

    The scene is made by a process of its own meanwhile (rerun is never called in this one).

    Raises:
        RecordingError: not a bundle, or a signed one.
        WorkerError: the scene's process failed.
    """
    if report or scene:
        refuse_signed(folder)
    with undone(lambda: remove_half_made(folder)):
        return _write_exports(folder, report, scene)


def _write_exports(folder: Path, report: bool, scene: bool) -> dict[str, Any]:
    bundle = open_bundle(folder)
    resolved, table = recorded_session(bundle), bundle.log.table()
    try:
        with ThreadPoolExecutor(1) as beside:
            pending = beside.submit(_scene, folder, resolved, table) if scene else None
            metrics = _report(folder, resolved, table, bundle.manifest, report)
            if pending is not None:
                pending.result()
    finally:  # where one could not be made, the other is listed all the same
        made = [name for name, wanted in ((REPORT, report), (SCENE, scene)) if wanted and (folder / name).exists()]
        add_export(folder, *made, instead_of=LIVE_SCENE if SCENE in made else None)
    return metrics


def write_report(folder: Path) -> dict[str, Any]:
    """Write report.html into the bundle and return its metrics.

    Raises:
        RecordingError: not a bundle, or a signed one.
    """
    return write_exports(folder, scene=False)


def write_scene(folder: Path) -> Path:
    """Write scene.rrd into the bundle and return its path.

    Raises:
        RecordingError: not a bundle, or a signed one.
        WorkerError: the process that writes it failed.
    """
    refuse_signed(folder)
    bundle = open_bundle(folder)
    _scene(folder, recorded_session(bundle), bundle.log.table())
    add_export(folder, SCENE, instead_of=LIVE_SCENE)
    return folder / SCENE


def open_viewer(path: Path) -> None:
    """Open a scene in rerun's viewer, in a process of its own that stays open when this one ends."""
    subprocess.Popen([sys.executable, "-m", "rerun", str(path)], stdin=subprocess.DEVNULL)


def _course(resolved: ResolvedSession) -> Course | None:
    return None if resolved.world is None else Course(resolved.world)


def _report(folder: Path, resolved: ResolvedSession, table: LogTable, manifest: Manifest, page: bool) -> dict[str, Any]:
    from simconsole.evaluation.metrics.drive_metrics import metrics
    from simconsole.evaluation.metrics.table import drive_of
    from simconsole.evaluation.report.page import write_report as write_page

    course, title = _course(resolved), resolved.session.title or folder.name
    first_tick = int(table.ticks[0]) if len(table.ticks) else 1
    faults = [fault_label(fault) for fault in resolved.session.scenario.faults]
    if page:
        return write_page(
            folder / REPORT,
            table.vectors,
            table.columns,
            table.tick_hz,
            course,
            title,
            _facts(resolved, manifest),
            first_tick=first_tick,
            faults=faults,
            latency_us=manifest.summary.get("latency_us"),
        )
    return metrics(drive_of(table.vectors, table.columns, table.tick_hz, first_tick), course, None, faults)


def _facts(resolved: ResolvedSession, manifest: Manifest) -> dict[str, object]:
    session = resolved.session
    return {
        **provenance_facts(manifest.provenance),
        "vehicle": session.scenario.vehicle,
        "world": session.environment.world or "none",
        "driver": session.devices.driver,
        "pacing": session.mode.pacing,
        **{
            key.replace("_", " "): value
            for key, value in manifest.summary.items()
            if not isinstance(value, dict | list)
        },
    }


def _scene(folder: Path, resolved: ResolvedSession, table: LogTable) -> None:
    from simconsole.scene.viewer.export import export_apart

    export_apart(scene_job(resolved, table.vectors, table.ticks, table.columns, table.tick_hz), folder / SCENE)
