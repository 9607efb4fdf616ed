"""`simconsole replay | verify | sign | compare | report | view | pack | unpack`: what can be done with a bundle."""

import re
import time
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simconsole.cli.differing import columns_text, differences_text, plain_differences, read_tolerances
from simconsole.cli.outcome import Outcome
from simconsole.cli.progress import Progress
from simconsole.cli.terminal.talk import say
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.manifest import SIGNATURE, read_manifest, refuse_signed
from simconsole.recording.bundles.pack import Sizes, Watch
from simconsole.recording.bundles.pack import pack as pack_bundle
from simconsole.recording.bundles.pack import unpack as unpack_bundle
from simconsole.recording.bundles.verification import coverage, examine, inexact
from simconsole.recording.compare import compare as compare_logs
from simconsole.values.errors import RecordingError

if TYPE_CHECKING:
    from simconsole.processes.running_scene import RunningScene

LOOK_S: Final = 0.05
REPLAY: Final = ("recorded", "replayed")
COMPARISON: Final = ("first", "second")


def replay(options: Namespace) -> Outcome:
    """Re-simulate a bundle from its recorded inputs; code 1 with a table of the fields that differ.

    Of a session with several platforms each is replayed alone.
    """
    if options.set:
        return _counterfactual(options)
    if options.out is not None:
        raise RecordingError("command line: --out: only with --set, which makes another drive")
    folder = Path(options.bundle)
    first = _replayed(folder, options.tolerances)
    others = {name: _replayed(folder / name, options.tolerances) for name in read_manifest(folder).platforms}
    if not others:
        return first
    code = max(outcome.code for outcome in (first, *others.values()))
    results = {**first.results, "platforms": {name: outcome.results for name, outcome in others.items()}}
    return Outcome(code, results, "\n".join((first.text, *(outcome.text for outcome in others.values()))))


def _replayed(folder: Path, tolerances: str | None) -> Outcome:
    """Re-simulate what one platform's bundle holds."""
    from simconsole.recording.bundles.replay_bundle import replay_bundle

    with Progress("replaying") as progress:
        result = replay_bundle(folder, read_tolerances(tolerances), progress.count)
    covered = coverage(folder)
    said = inexact(folder, read_manifest(folder))
    results = {
        **result._asdict(),
        "digest": result.digest.hex(),
        "bit_exact": not said,
        "differences": plain_differences(result.differences, REPLAY),
        "vouches_for": covered.replayed if result.good and result.hashes_equal else [],
    }
    if result.differences:
        verdict = f"{folder}: {result.ticks} ticks replayed, {len(result.differences)} fields differ"
    elif result.problems:
        verdict = f"{folder}: {result.ticks} ticks replayed, equal, but they are not the whole drive"
    elif result.hashes_equal:
        verdict = f"{folder}: {result.ticks} ticks replayed, every hash equal"
        says = f"this vouches for {', '.join(covered.replayed)}; for {', '.join(covered.others)}: simconsole verify"
        verdict = f"{verdict}\n{says}"
    else:
        verdict = f"{folder}: {result.ticks} ticks replayed, no field of both differs" + (
            " by more than its tolerance" if tolerances else ""
        )
    lines = [verdict, *([differences_text(result.differences, REPLAY)] if result.differences else [])]
    lines += columns_text(result.new, "new, not in the recording")
    lines += columns_text(result.missing, "in the recording only")
    return Outcome(0 if result.good else 1, results, "\n".join((*lines, *result.problems, *result.remarks, *said)))


def _counterfactual(options: Namespace) -> Outcome:
    """Make the drive again with values changed, into a bundle of its own with a paired report."""
    from simconsole.evaluation.counterfactual.drive_again import OPEN_LOOP, changes_of, drive_again
    from simconsole.evaluation.counterfactual.pair import PAIR, write_pair

    folder, values = Path(options.bundle), changes_of(options.set)
    beside = re.sub(r"[^\w.=-]", "_", "-".join((folder.resolve().name, *options.set)))
    out = Path(options.out) if options.out else folder.resolve().with_name(beside)
    again = drive_again(folder, values, out)
    found = write_pair(folder, again, values)
    remarks = []
    if not again.unchanged.equal:
        remarks.append(
            f"{folder}: unchanged, this version makes it differently in {len(again.unchanged.differences)} fields"
        )
    fields = again.changed.differences
    results = {"bundle": str(out), "report": str(out / PAIR), "fields": len(fields), "driver": OPEN_LOOP, **found}
    lines = [f"{folder}: {again.changed.ticks} ticks with {', '.join(options.set)}: {len(fields)} fields differ"]
    lines += [f"{OPEN_LOOP}", f"at most {found['apart_max_m']:.3f} m apart", str(out), str(out / PAIR)]
    problems = list(again.changed.problems)
    return Outcome(1 if problems else 0, {**results, "problems": problems}, "\n".join((*lines, *remarks, *problems)))


def verify(options: Namespace) -> Outcome:
    """Check every byte of a bundle, and its signature; code 1 with one line for each problem."""
    found = examine(Path(options.bundle), Path(options.signer) if options.signer else None)
    results = {"good": not found.problems, "problems": found.problems, "remarks": found.remarks}
    verdict = found.problems or [f"{options.bundle}: whole"]
    return Outcome(1 if found.problems else 0, results, "\n".join((*verdict, *found.remarks)))


def sign(options: Namespace) -> Outcome:
    """Sign a whole bundle, take its signature away, or make a key; code 1 if the bundle is not whole."""
    from simconsole.recording.bundles.signing import make_key, remove_signature
    from simconsole.recording.bundles.signing import sign as sign_bundle

    asked = [word for word in ("key", "new_key", "remove") if getattr(options, word)]
    if len(asked) != 1 or (options.bundle is None) != (asked == ["new_key"]):
        raise RecordingError("command line: BUNDLE --key FILE, BUNDLE --remove, or --new-key FILE alone")
    if options.new_key:
        public = make_key(Path(options.new_key))
        text = f"{options.new_key}: keep it secret; {options.new_key}.pub: give it to who shall check ({public})"
        return Outcome(0, {"key": options.new_key, "public_key": public}, text)
    folder = Path(options.bundle)
    if options.remove:
        remove_signature(folder)
        return Outcome(0, {"removed": True}, f"{folder}: signed no longer")
    refuse_signed(folder)
    if problems := examine(folder).problems:
        said = [f"{folder}: not signed, for it is not whole", *problems]
        return Outcome(1, {"signed": False, "problems": problems}, "\n".join(said))
    signature = sign_bundle(folder, Path(options.key), options.name)
    results = {"signed": True, "problems": [], "public_key": signature.public_key}
    return Outcome(0, results, f"{folder / SIGNATURE}: signed with the key {signature.public_key}")


def compare(options: Namespace) -> Outcome:
    """Compare two bundles tick by tick; code 1 with a table of the fields that differ."""
    first, second = open_bundle(Path(options.bundle)), open_bundle(Path(options.other))
    found = compare_logs(first.log, second.log, read_tolerances(options.tolerances))
    problems = first.problems() + second.problems()
    results = {
        **found._asdict(),
        "differences": plain_differences(found.differences, COMPARISON),
        "messages": [stream._asdict() for stream in found.messages],
        "problems": problems,
    }
    lines = columns_text(found.only_first, "in the first only") + columns_text(found.only_second, "in the second only")
    if found.equal:
        return _judged(problems, results, "\n".join((f"{found.ticks} ticks, all equal", *lines)))
    lines = [f"{found.ticks} ticks compared, {len(found.differences)} fields differ", *lines]
    if found.differences:
        lines.insert(1, differences_text(found.differences, COMPARISON))
    for stream in found.messages:
        unlike = f"{list(stream.first)} and {list(stream.second)}"
        lines.append(
            f"stream {stream.stream}: differs in {stream.ticks} ticks, first at tick {stream.first_tick}: {unlike}"
        )
    return Outcome(1, results, "\n".join((*lines, *([found.reason] if found.reason else []), *problems)))


def report(options: Namespace) -> Outcome:
    """Write report.html into the bundle; with a second bundle a page of both side by side."""
    from simconsole.evaluation.report.exports import write_report, write_side_by_side

    folder = Path(options.bundle)
    if options.other is not None:
        beside = folder.resolve().with_name(f"{folder.resolve().name}-and-{Path(options.other).resolve().name}.html")
        page = Path(options.out) if options.out else beside
        found = write_side_by_side(folder, Path(options.other), page)
        return Outcome(0, {"page": str(page), "drives": found}, str(page))
    if options.out is not None:
        raise RecordingError("command line: --out: only with a second bundle; a report lies in its bundle")
    with Progress("writing the report") as progress:
        metrics = write_report(folder, progress.done)
    return _of_whole_drive(options.bundle, metrics, str(folder / "report.html"))


def view(options: Namespace) -> Outcome:
    """Write scene.rrd into the bundle and open it in rerun, unless told not to. That of a signed bundle stays.

    A drive that goes on is shown while it does: that of the bundle, or the newest where none is named.
    """
    from simconsole.processes.running_scene import newest_scene, scene_of

    running = newest_scene() if options.bundle is None else scene_of(Path(options.bundle))
    if running is not None:
        return _serve(running.path, running, options)
    from simconsole.evaluation.report.exports import write_scene
    from simconsole.evaluation.report.scene_export import SCENE
    from simconsole.scene.viewer.scene_server import open_native

    folder = Path(options.bundle)
    signed = (folder / SIGNATURE).exists() and SCENE in read_manifest(folder).files
    with Progress("writing the scene") as progress:
        path = folder / SCENE if signed else write_scene(folder, progress.done)
    if options.browser and not options.no_open:
        return _serve(path, None, options)
    if not options.no_open:
        open_native(str(path))
    return _of_whole_drive(options.bundle, {"scene": str(path)}, str(path))


def _serve(path: Path, drive: "RunningScene | None", options: Namespace) -> Outcome:
    """Serve a scene until Ctrl-C, of a drive that goes on or of none, and open a viewer unless told not to.

    What was shown stays in the viewers, and is served on, after the drive has ended.

    Raises:
        WorkerError: rerun's server does not start, or has ended.
    """
    from simconsole.processes.lifetimes import INTERRUPTED, Interrupt
    from simconsole.scene.viewer.scene_server import Ports, SceneServer, open_browser, open_native

    served, ended, window = 0, drive is None, None
    with Interrupt() as interrupt:
        server = SceneServer(path, Ports(options.port, options.web_port), options.memory)
        native, browser = server.addresses
        say(f"serving {path}")
        say(f"viewers of this machine: rerun --connect {native}")
        say(f"browsers of this machine: {browser}")
        try:
            if options.browser:
                open_browser(browser)
            elif not options.no_open:
                window = open_native(native)
            while not interrupt.raised:
                served += server.pump()
                if window is not None and window.poll() is not None:
                    if window.returncode:
                        say("rerun's own window could not be opened, as it says above: try the browser's address")
                    window = None
                if drive is not None and not ended and not drive.goes_on:
                    ended = True
                    say("the drive has ended; Ctrl-C ends the view")
                time.sleep(LOOK_S)
        finally:
            server.close()
    results = {"scene": str(path), "served_bytes": served, "native": native, "browser": browser, "ended": ended}
    return Outcome(INTERRUPTED, results, f"{path}: {served / 1e6:.1f} MB served")


def pack(options: Namespace) -> Outcome:
    """Let drive.parquet stand for the log of each bundle; code 2 with one line for each that cannot be packed."""
    return _each(options.bundles, pack_bundle, "packing")


def unpack(options: Namespace) -> Outcome:
    """Make the log of each packed bundle again; code 2 with one line for each where it cannot be done."""
    return _each(options.bundles, unpack_bundle, "unpacking")


def _each(folders: list[str], change: Callable[[Path, Watch], Sizes], doing: str) -> Outcome:
    sizes: dict[str, dict[str, int]] = {}
    failures: dict[str, str] = {}
    lines = []
    for folder in folders:
        try:
            with Progress(doing) as progress:
                found = change(Path(folder), progress.done)
        except RecordingError as error:
            failures[folder] = str(error)
            lines.append(str(error))
        else:
            sizes[folder] = found._asdict()
            lines.append(f"{folder}: log {found.log_bytes} bytes, packed {found.packed_bytes}")
    code = RecordingError.exit_code if failures else 0
    return Outcome(code, {"bundles": sizes, "failures": failures}, "\n".join(lines))


def _of_whole_drive(name: str, results: dict[str, Any], text: str) -> Outcome:
    """Return what was made from a bundle, and whether that is the whole drive."""
    bundle = open_bundle(Path(name))
    for _ in bundle.log:
        pass
    return _judged(bundle.problems(), {**results, "problems": bundle.problems()}, text)


def _judged(problems: list[str], results: dict[str, Any], text: str) -> Outcome:
    return Outcome(1 if problems else 0, results, "\n".join((text, *problems)))
