"""`simconsole replay`: of one bundle, of several, or of the newest where none is named."""

from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from simconsole.cli.outcome import Outcome
from simconsole.recording.bundles.bundle import SESSION_FILE
from simconsole.recording.bundles.manifest import MANIFEST
from simconsole.values.errors import RecordingError, SimConsoleError

OUT: Final = Path("out")
_DEPTHS: Final = (f"*/{MANIFEST}", f"*/*/{MANIFEST}")
"""Where commands put bundles by themselves: out/demo-TIME, out/turtlebot-TIME/bundle."""


def replay(options: Namespace) -> Outcome:
    """Re-simulate each bundle; code 1 where one differs, 2 where one cannot be read.

    Raises:
        RecordingError: no bundle is named and none is there; or --set with several.
    """
    from simconsole.cli.recordings import replay as replay_one

    folders = bundles(options.bundles)
    if len(folders) == 1:
        return replay_one(Namespace(**{**vars(options), "bundle": folders[0]}))
    if options.set:
        raise RecordingError(f"command line: --set: value of {len(folders)} bundles: of one bundle")
    outcomes = {}
    for folder in folders:
        try:
            outcomes[folder] = replay_one(Namespace(**{**vars(options), "bundle": folder}))
        except SimConsoleError as error:
            outcomes[folder] = Outcome(error.exit_code, {"error": str(error)}, str(error))
    results = {"bundles": {folder: outcome.results for folder, outcome in outcomes.items()}}
    text = "\n".join(outcome.text for outcome in outcomes.values())
    return Outcome(max(outcome.code for outcome in outcomes.values()), results, text)


def bundles(named: Sequence[str]) -> list[str]:
    """Return the bundles that are named, each once; the newest below `out` where none is.

    Raises:
        RecordingError: none is named and none is there.
    """
    return list(dict.fromkeys(named)) or [str(newest_bundle(OUT))]


def newest_bundle(out: Path) -> Path:
    """Return the bundle below a folder whose drive began last: its session is written then, and never again.

    Raises:
        RecordingError: there is none.
    """
    found = [path.parent for depth in _DEPTHS for path in out.glob(depth)]
    alone = [folder for folder in found if not (folder.parent / MANIFEST).exists()]  # no platform of another bundle
    if not alone:
        raise RecordingError(f"{out}: no bundle below it: name one, or drive first: simconsole demo")
    return max(alone, key=lambda folder: ((folder / SESSION_FILE).stat().st_mtime_ns, folder.name))
