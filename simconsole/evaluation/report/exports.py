"""What is made from a bundle afterwards: report.html and scene.rrd. Nothing a replay needs."""

from collections.abc import Callable
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simconsole.evaluation.report.metric_rows import rounded
from simconsole.evaluation.report.scene_export import SCENE, scene_process
from simconsole.processes.lifetimes import remove_half_made, undone
from simconsole.profiles.faults import fault_label
from simconsole.profiles.parts.turtlebot import TurtlebotProfile
from simconsole.profiles.world import ArenaProfile
from simconsole.recording.bundles.bundle import Bundle, add_export, open_bundle
from simconsole.recording.bundles.manifest import Manifest, refuse_signed
from simconsole.recording.bundles.provenance import facts as provenance_facts
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.session.scene_worker import LIVE_SCENE
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import RecordingError
from simconsole.world.arena.outlines import Array, wall_lines
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route

if TYPE_CHECKING:
    from simconsole.evaluation.metrics.table import Drive

REPORT: Final = "report.html"
PASSES: Final = 10
"""How often a report passes over its drive: to count the ticks, for the track, the mode changes, the acceleration, the
marks, the faults, the wheel, the take-overs (where there are any), the map and the traces."""
Told = Callable[[str, float], object]
"""Told what is being made, and the share of it that is done, from 0 to 1."""


def _untold(what: str, share: float) -> None:
    """Tell nothing: the default of `Told`."""


def write_exports(folder: Path, report: bool = True, scene: bool = True, told: Told = _untold) -> dict[str, Any]:
    """Write report and scene of the bundle in `folder`, each where wanted; return the report's metrics.

    The scene is made by a process of its own meanwhile (rerun is never called in this one). Neither has a deadline.

    Args:
        folder: the bundle.
        report: whether to write report.html.
        scene: whether to write scene.rrd.
        told: how far each of them is; called in two threads.

    Raises:
        RecordingError: not a bundle, or a signed one.
        WorkerError: the scene's process failed.
    """
    if report or scene:
        refuse_signed(folder)
    with undone(lambda: remove_half_made(folder)):
        return _write_exports(folder, report, scene, told)


def _write_exports(folder: Path, report: bool, scene: bool, told: Told) -> dict[str, Any]:
    bundle = open_bundle(folder)
    try:
        with scene_process(folder, partial(told, "scene")) if scene else nullcontext(lambda: None) as wait:
            try:
                metrics = _report(bundle, report, partial(told, "report"))
            finally:
                wait()
    finally:  # where one could not be made, the other is listed all the same
        made = [name for name, wanted in ((REPORT, report), (SCENE, scene)) if wanted and (folder / name).exists()]
        add_export(folder, *made, instead_of=LIVE_SCENE if SCENE in made else None)
    return metrics


def write_report(folder: Path, told: Told = _untold) -> dict[str, Any]:
    """Write report.html into the bundle and return its metrics.

    Raises:
        RecordingError: not a bundle, or a signed one.
    """
    return write_exports(folder, scene=False, told=told)


def write_side_by_side(first: Path, second: Path, page: Path) -> dict[str, Any]:
    """Write the page of two bundles side by side; return the metrics of each by its name.

    Raises:
        RecordingError: one of them is no bundle, both are the same, or the page cannot be written.
    """
    from simconsole.evaluation.metrics.table import recorded_drive
    from simconsole.evaluation.report.paired_page import Side
    from simconsole.evaluation.report.side_page import write_side_page

    if first.resolve() == second.resolve():
        raise RecordingError(f"{second}: is the same bundle: two different ones can be shown side by side")
    bundles = open_bundle(first), open_bundle(second)
    opened = [recorded_session(bundle) for bundle in bundles]
    names = [folder.resolve().name for folder in (first, second)]
    if names[0] == names[1]:
        names = [str(folder) for folder in (first, second)]
    one, other = (
        Side(name, recorded_drive(bundle.log), _route(resolved))
        for name, bundle, resolved in zip(names, bundles, opened, strict=True)
    )
    a, b = (_facts(resolved, bundle.manifest) for resolved, bundle in zip(opened, bundles, strict=True))
    return write_side_page(page, (one, other), (a, b))


def write_scene(folder: Path, told: Told = _untold) -> Path:
    """Write scene.rrd into the bundle and return its path.

    Raises:
        RecordingError: not a bundle, or a signed one.
        WorkerError: the process that writes it failed.
    """
    refuse_signed(folder)
    open_bundle(folder)
    with undone(lambda: remove_half_made(folder)), scene_process(folder, partial(told, "scene")) as wait:
        wait()
    add_export(folder, SCENE, instead_of=LIVE_SCENE)
    return folder / SCENE


def _route(resolved: ResolvedSession) -> Route | None:
    """Return the theoretical path; robots have none: the way round an arena is one of many."""
    robot = isinstance(resolved.vehicle, TurtlebotProfile)
    return None if resolved.world is None or robot else open_world(resolved.world).route


def _walls(resolved: ResolvedSession) -> tuple[Array, ...] | None:
    """Return the walls round a robot; None: no robot drives."""
    if not isinstance(resolved.vehicle, TurtlebotProfile):
        return None
    return wall_lines(resolved.world) if isinstance(resolved.world, ArenaProfile) else ()


def _touches(resolved: ResolvedSession, drive: "Drive") -> dict[str, object]:
    """Return how often a robot has touched something, for the page."""
    if not isinstance(resolved.vehicle, TurtlebotProfile):
        return {}
    return {"times that it touched something": int(drive.columns("platform.motion.collisions")[0][-1])}


def _report(bundle: Bundle, page: bool, told: Callable[[float], object]) -> dict[str, Any]:
    from simconsole.evaluation.metrics.drive_metrics import metrics
    from simconsole.evaluation.metrics.table import recorded_drive
    from simconsole.evaluation.report.page import write_report as write_page

    resolved, manifest = recorded_session(bundle), bundle.manifest
    route, title = _route(resolved), resolved.session.title or bundle.folder.name
    faults = [fault_label(fault) for fault in resolved.session.scenario.faults]
    drive = recorded_drive(bundle.log, lambda passes: told(min(passes / PASSES, 1.0)))
    if page:
        return write_page(
            bundle.folder / REPORT,
            drive,
            route,
            title,
            {**_facts(resolved, manifest), **_touches(resolved, drive)},
            walls=_walls(resolved),
            faults=faults,
            latency_us=manifest.summary.get("latency_us"),
            acts=manifest.summary.get("acts", ()),
        )
    return metrics(drive, route, None, faults)


def _facts(resolved: ResolvedSession, manifest: Manifest) -> dict[str, object]:
    session = resolved.session
    return {
        **provenance_facts(manifest.provenance),
        "vehicle": session.scenario.vehicle,
        "world": session.environment.world or "none",
        "driver": session.devices.driver,
        "pacing": session.mode.pacing,
        "versions": ", ".join(f"{name} {version}" for name, version in manifest.versions.items()),
        **{
            key.replace("_", " "): rounded(value) if isinstance(value, float) else value
            for key, value in manifest.summary.items()
            if not isinstance(value, dict | list)
        },
    }
