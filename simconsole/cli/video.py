"""`simconsole video`: a recorded drive as a video, or one moment of it as a picture."""

import math
import sys
from argparse import Namespace
from collections.abc import Iterator
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from simconsole.cli.outcome import Outcome
from simconsole.cli.progress import Progress
from simconsole.recording.bundles.bundle import Bundle, open_bundle
from simconsole.values.errors import RecordingError

if TYPE_CHECKING:
    from simconsole.evaluation.video.drive_pictures import DrivePictures
    from simconsole.evaluation.video.drive_sound import DriveSound
    from simconsole.evaluation.video.moments import VideoFrame

SMALLEST_PX: Final = 320
LARGEST_PX: Final = 4096
EARLIER_FPS: Final = 10


def video(options: Namespace) -> Outcome:
    """Write a video of a bundle, or one PNG; code 1 where the bundle is not the whole drive."""
    folder = Path(options.bundle)
    bundle = open_bundle(folder)
    _check(options)
    pictures = _pictures(bundle, options)
    if pictures.is_cheap:
        print(f"{pictures.renderer} draws, no graphics card: no mirrors, no shadows (--rich: slowly)", file=sys.stderr)
    if options.png is not None:
        return _png(bundle, pictures, *options.png)
    from simconsole.evaluation.video.encoder import Frame, write_video
    from simconsole.evaluation.video.moments import moments

    path = Path(options.out) if options.out else folder.with_name(f"{folder.resolve().name}.mp4")
    end_s = _end_s(bundle) if options.to_s is None else options.to_s
    sound = _sound(bundle, options.fps)
    with Progress("drawing") as progress:
        _pass_over(bundle, pictures, options.from_s)
        found = moments(bundle.log, options.from_s, options.to_s, options.fps)
        told = _told(found, progress, options.from_s, end_s)
        seen = (Frame(pictures.draw(moment), sound.frame(moment)) for moment in told)
        frames = write_video(path, seen, options.fps)
    results = {"video": str(path), "frames": frames, "fps": options.fps, "bytes": path.stat().st_size}
    return _judged(bundle, results, f"{path}: {frames} frames, {frames / options.fps:.1f} s")


def _png(bundle: Bundle, pictures: "DrivePictures", at: str, name: str) -> Outcome:
    from simconsole.evaluation.video.encoder import write_png
    from simconsole.evaluation.video.moments import moments

    try:
        at_s = float(at)
    except ValueError:
        raise RecordingError(f"--png: value {at!r}: a time in s") from None
    moment = next(moments(bundle.log, at_s, None, 1))
    _pass_over(bundle, pictures, moment.t_s)
    write_png(Path(name), pictures.draw(moment))
    return Outcome(0, {"picture": name, "t_s": moment.t_s, "tick": moment.snapshot.tick}, name)


def _pass_over(bundle: Bundle, pictures: "DrivePictures", until_s: float) -> None:
    """Show the instruments the drive up to a time in s, as often as they change."""
    from simconsole.evaluation.video.moments import moments

    if until_s > 0.0:
        before = moments(bundle.log, 0.0, None, EARLIER_FPS)
        pictures.pass_over(takewhile(lambda moment: moment.t_s < until_s, before))


def _check(options: Namespace) -> None:
    if not 1 <= options.fps <= 240:
        raise RecordingError(f"--fps: value {options.fps}: 1 to 240")
    if not (math.isfinite(options.from_s) and options.from_s >= 0.0):
        raise RecordingError(f"--from: value {options.from_s:g}: a time in s, at least 0")
    if options.to_s is not None and not (math.isfinite(options.to_s) and options.to_s > options.from_s):
        raise RecordingError(f"--to: value {options.to_s:g}: a time in s after --from ({options.from_s:g})")


def _size(text: str) -> tuple[int, int]:
    width, _, height = text.partition("x")
    if width.isdecimal() and height.isdecimal():
        found = int(width), int(height)
        if all(number % 2 == 0 and SMALLEST_PX <= number <= LARGEST_PX for number in found):
            return found
    allowed = f"WIDTHxHEIGHT, both even and from {SMALLEST_PX} to {LARGEST_PX}, such as 1280x720"
    raise RecordingError(f"--size: value {text!r}: {allowed}")


def _pictures(bundle: Bundle, options: Namespace) -> "DrivePictures":
    from msgspec.structs import replace

    from simconsole.evaluation.video.drive_pictures import DrivePictures, Wanted
    from simconsole.recording.bundles.replay_bundle import recorded_session
    from simconsole.session.resolution import language_of

    width, height = _size(options.size)
    wanted = Wanted(
        width, height, options.camera, night=options.night, rich=options.rich, large_text=options.large_text
    )
    resolved = recorded_session(bundle)
    if options.language is not None:
        resolved = replace(resolved, language=language_of(options.language))
    return DrivePictures(resolved, wanted)


def _sound(bundle: Bundle, fps: int) -> "DriveSound":
    from simconsole.evaluation.video.drive_sound import DriveSound
    from simconsole.recording.bundles.replay_bundle import recorded_session

    return DriveSound(recorded_session(bundle), fps)


def _end_s(bundle: Bundle) -> float:
    return float(bundle.manifest.ticks / bundle.log.header.tick_hz) if bundle.manifest.finished else math.inf


def _told(found: "Iterator[VideoFrame]", progress: Progress, from_s: float, to_s: float) -> "Iterator[VideoFrame]":
    for moment in found:
        yield moment
        progress.done("video", min(1.0, (moment.t_s - from_s) / max(to_s - from_s, 1e-9)))


def _judged(bundle: Bundle, results: dict[str, Any], text: str) -> Outcome:
    problems = bundle.problems()
    return Outcome(1 if problems else 0, {**results, "problems": problems}, "\n".join((text, *problems)))
