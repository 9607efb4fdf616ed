"""`simconsole replay | verify | compare | report | view`: what can be done with a bundle."""

from argparse import Namespace
from pathlib import Path
from typing import Any

from simconsole.cli.outcome import Outcome
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.bundle import verify as verify_bundle
from simconsole.recording.compare import compare as compare_logs


def replay(options: Namespace) -> Outcome:
    """Re-simulate a bundle from its recorded inputs; code 1 and the first differing tick and field otherwise."""
    from simconsole.recording.bundles.replay_bundle import replay_bundle

    result = replay_bundle(Path(options.bundle))
    results = {
        "equal": result.equal,
        "ticks": result.ticks,
        "digest": result.digest.hex(),
        "difference": None if result.difference is None else result.difference._asdict(),
        "problems": result.problems,
        "remarks": result.remarks,
    }
    if not result.equal:
        verdict = f"{options.bundle}: differs at {result.difference}"
    elif result.problems:
        verdict = f"{options.bundle}: {result.ticks} ticks replayed, equal, but they are not the whole drive"
    else:
        verdict = f"{options.bundle}: {result.ticks} ticks replayed, every hash equal"
    return Outcome(0 if result.good else 1, results, "\n".join((verdict, *result.problems, *result.remarks)))


def verify(options: Namespace) -> Outcome:
    """Check a bundle's manifest, checksums and hash chain; code 1 with one line for each problem."""
    problems = verify_bundle(Path(options.bundle))
    if problems:
        return Outcome(1, {"good": False, "problems": problems}, "\n".join(problems))
    return Outcome(0, {"good": True, "problems": []}, f"{options.bundle}: whole")


def compare(options: Namespace) -> Outcome:
    """Compare two bundles tick by tick; code 1 with the first differing tick and field and a window around it."""
    first, second = open_bundle(Path(options.bundle)), open_bundle(Path(options.other))
    found = compare_logs(first.log, first.log.header, second.log, second.log.header)
    problems = first.problems() + second.problems()
    results = {
        "equal": found.equal,
        "ticks": found.ticks,
        "difference": None if found.difference is None else found.difference._asdict(),
        "problems": problems,
    }
    if found.equal:
        return _judged(problems, results, f"{found.ticks} ticks, all equal")
    return Outcome(1, results, "\n".join((f"{found.difference or 'not equal'}\n{found.window}", *problems)))


def report(options: Namespace) -> Outcome:
    """Write report.html into the bundle."""
    from simconsole.evaluation.report.exports import write_report

    metrics = write_report(Path(options.bundle))
    return _of_whole_drive(options.bundle, metrics, str(Path(options.bundle) / "report.html"))


def view(options: Namespace) -> Outcome:
    """Write scene.rrd into the bundle and open it in rerun, unless told not to."""
    from simconsole.evaluation.report.exports import open_viewer, write_scene

    path = write_scene(Path(options.bundle))
    if not options.no_open:
        open_viewer(path)
    return _of_whole_drive(options.bundle, {"scene": str(path)}, str(path))


def _of_whole_drive(name: str, results: dict[str, Any], text: str) -> Outcome:
    """Return what was made from a bundle, and whether that is the whole drive."""
    bundle = open_bundle(Path(name))
    for _ in bundle.log:
        pass
    return _judged(bundle.problems(), {**results, "problems": bundle.problems()}, text)


def _judged(problems: list[str], results: dict[str, Any], text: str) -> Outcome:
    return Outcome(1 if problems else 0, results, "\n".join((text, *problems)))
