"""The pictures and the video of README.md and docs/, from one recorded drive in which every mode occurs.

Run: python scripts/make_pictures.py [BUNDLE] [--out docs/images]

Without a bundle it drives first (scripts/pictures/modes.yaml). It draws, by the functions that the console itself uses:
`drive.png`, the instruments beside the report's map; `view.jpg`, the road from the seat; `modes_day.jpg` and
`modes_night.jpg`, a picture of each mode; `german.jpg`, the display in German with large text; `drive.mp4`, ten seconds
of the drive, and `drive.webp`, the same without sound for pages that play no video. A drive that lacks a mode is
refused.
"""

import argparse
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from msgspec.structs import replace
from PIL import Image

from simconsole.evaluation.metrics.drive_metrics import ModeChange, mode_changes
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import track
from simconsole.evaluation.report.figure_map import draw_map
from simconsole.evaluation.report.figures import STYLE
from simconsole.evaluation.video.drive_pictures import DrivePictures, Wanted
from simconsole.evaluation.video.drive_sound import DriveSound
from simconsole.evaluation.video.encoder import Frame, write_video
from simconsole.evaluation.video.moments import VideoFrame, moments
from simconsole.hud.window.raster import snapshot_png
from simconsole.recording.bundles.bundle import Bundle, open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.session.resolution import language_of
from simconsole.session.view.external_view import display_settings
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world

SESSION = Path(__file__).parent / "pictures" / "modes.yaml"
IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"
HEIGHT_PX = 540
MAP_INCH = (9.2, 7.4)
"""As in the report, where its words fit."""
TILE = (800, 600)
SHOWN_TILE = (480, 360)
COLUMNS = 4
JPEG_QUALITY = 80
INTO_MODE_S = 1.5
"""A mode's picture is this much later than its beginning, or in its middle where it is shorter."""
LATER_S = {Mode.AUTONOMOUS: 10.0}
"""Where the car is well under way, before the traffic lights."""
APART_M = 40.0
"""On the map changes of mode that are nearer to each other than this would be written over each other."""
VIDEO = (640, 360)
VIDEO_S = 10.0
VIDEO_BEFORE_S = 4.0
"""The video begins so long before the person is asked to take over."""
FPS = 25
CRF = 34
SOUND_BPS = 32_000
ANIMATED_EVERY = 5
ANIMATED_PX = (480, 270)
ANIMATED_QUALITY = 35
MADE = ("drive.png", "view.jpg", "modes_day.jpg", "modes_night.jpg", "german.jpg", "drive.mp4", "drive.webp")
LARGEST_BYTES = 300_000
ALL_BYTES = 1_250_000


class Drive(NamedTuple):
    """A recorded drive, and when it was in which mode."""

    bundle: Bundle
    resolved: ResolvedSession
    table: Any
    in_mode_s: dict[Mode, float]

    def moment(self, at_s: float) -> VideoFrame:
        """Return the first moment from `at_s` on."""
        return next(moments(self.bundle.log, at_s, None, 1))

    def snapshot(self, at_s: float) -> Snapshot:
        """Return the tick at `at_s`."""
        index = int(np.searchsorted(self.table.ticks, at_s * self.table.tick_hz))
        return Snapshot(int(self.table.ticks[index]), self.table.tick_hz, self.table.vectors[index])


def opened(folder: Path) -> Drive:
    """Read a drive."""
    bundle = open_bundle(folder)
    table = bundle.log.table()
    modes = table.vectors[:, table.columns.index("arbitration.mode")]
    cuts = np.flatnonzero(np.diff(modes)) + 1
    starts, ends = np.append(0, cuts), np.append(cuts, len(modes))
    found: dict[Mode, float] = {}
    for mode in Mode:
        spans = [(end - start, start) for start, end in zip(starts, ends, strict=True) if modes[start] == mode]
        if not spans:
            raise SystemExit(f"{folder}: no tick in mode {mode_label(mode)}")
        length, start = max(spans)
        found[mode] = float(table.ticks[start]) / table.tick_hz + min(INTO_MODE_S, 0.5 * length / table.tick_hz)
    return Drive(bundle, recorded_session(bundle), table, found)


def pictures(drive: Drive, wanted: Wanted, language: str = "english") -> DrivePictures:
    """Return what draws a drive."""
    return DrivePictures(replace(drive.resolved, language=language_of(language)), wanted)


def sheet(tiles: list[Image.Image]) -> Image.Image:
    """Return pictures in rows of four."""
    width, height = SHOWN_TILE
    rows = -(-len(tiles) // COLUMNS)
    whole = Image.new("RGB", (COLUMNS * width, rows * height))
    for number, tile in enumerate(tiles):
        small = tile.resize(SHOWN_TILE, Image.Resampling.LANCZOS)
        whole.paste(small, ((number % COLUMNS) * width, (number // COLUMNS) * height))
    return whole


def modes(drive: Drive, path: Path, *, night: bool) -> None:
    """Write a picture of each mode."""
    tiles = []
    for mode in Mode:
        drawn = pictures(drive, Wanted(*TILE, night=night, rich=True))
        tiles.append(Image.fromarray(remembering(drive, drawn, drive.in_mode_s[mode] + LATER_S.get(mode, 0.0))))
    sheet(tiles).save(path, quality=JPEG_QUALITY, optimize=True)


def one(drive: Drive, path: Path, wanted: Wanted, mode: Mode, language: str) -> None:
    """Write one picture of a mode."""
    picture = remembering(drive, pictures(drive, wanted, language), drive.in_mode_s[mode] + LATER_S.get(mode, 0.0))
    Image.fromarray(picture).save(path, quality=JPEG_QUALITY, optimize=True)


def remembering(drive: Drive, drawn: DrivePictures, at_s: float) -> Any:
    """Return the picture of a moment, with what the instruments remember of the drive before."""
    drawn.pass_over(moment for moment in moments(drive.bundle.log, max(0.0, at_s - 20.0), at_s, 10))
    return drawn.draw(drive.moment(at_s))


def instruments_and_map(drive: Drive, path: Path) -> None:
    """Write the instruments while the autopilot drives, beside the driven path."""
    table = drive.table
    with tempfile.TemporaryDirectory() as folder:
        left, right = Path(folder) / "instruments.png", Path(folder) / "map.png"
        settings = display_settings(drive.resolved)
        snapshot_png(
            drive.snapshot(drive.in_mode_s[Mode.AUTONOMOUS] + LATER_S[Mode.AUTONOMOUS]), left, settings=settings
        )
        driven = drive_of(table.vectors, table.columns, table.tick_hz, int(table.ticks[0]))
        course = None if drive.resolved.world is None else open_world(drive.resolved.world).route
        way = track(driven, course)
        style: dict[Any, Any] = STYLE | {"axes.grid": False}
        with rc_context(style):
            figure = Figure(figsize=MAP_INCH, dpi=200, layout="constrained")
            FigureCanvasAgg(figure)
            draw_map(figure, driven, way, apart(mode_changes(driven, way)), course)
            figure.savefig(right)
        halves = [scaled(Image.open(half)) for half in (left, right)]
    picture = Image.new("RGB", (sum(half.width for half in halves), HEIGHT_PX))
    picture.paste(halves[0], (0, 0))
    picture.paste(halves[1], (halves[0].width, 0))
    picture.save(path, optimize=True)


def apart(changes: list[ModeChange]) -> list[ModeChange]:
    """Return the changes that are not right behind another one."""
    kept = changes[:1]
    for change in changes[1:]:
        if change.distance_m - kept[-1].distance_m >= APART_M:
            kept.append(change)
    return kept


def scaled(image: Image.Image) -> Image.Image:
    """Return the image at the picture's height."""
    return image.convert("RGB").resize((image.width * HEIGHT_PX // image.height, HEIGHT_PX), Image.Resampling.LANCZOS)


def video(drive: Drive, path: Path) -> None:
    """Write the seconds in which the person is asked to take over."""
    begin_s = drive.in_mode_s[Mode.TAKEOVER_REQUESTED] - INTO_MODE_S - VIDEO_BEFORE_S
    drawn = pictures(drive, Wanted(*VIDEO, rich=True))
    sound = DriveSound(drive.resolved, FPS)

    def frames() -> Iterator[Frame]:
        for moment in moments(drive.bundle.log, begin_s, begin_s + VIDEO_S, FPS):
            yield Frame(drawn.draw(moment), sound.frame(moment))

    write_video(path, frames(), FPS, CRF, SOUND_BPS)


def animation(film: Path, path: Path) -> None:
    """Write a video again as a picture that moves, smaller and with fewer frames."""
    import av

    with av.open(str(film)) as opened_film:
        frames = [Image.fromarray(frame.to_ndarray(format="rgb24")) for frame in opened_film.decode(video=0)][
            ::ANIMATED_EVERY
        ]
    first, *others = [frame.resize(ANIMATED_PX, Image.Resampling.LANCZOS) for frame in frames]
    frame_ms = round(1000 * ANIMATED_EVERY / FPS)
    first.save(path, save_all=True, append_images=others, duration=frame_ms, loop=0, quality=ANIMATED_QUALITY, method=6)


def main() -> None:
    """Drive where no drive is named, draw everything, and say how large it is."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bundle", type=Path, nargs="?")
    parser.add_argument("--out", type=Path, default=IMAGES)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        place = given.bundle or Path(folder) / "modes"
        if given.bundle is None:
            subprocess.run([sys.executable, "-m", "simconsole", "drive", SESSION, "--out", place], check=True)
        drive, out = opened(place), given.out
        out.mkdir(parents=True, exist_ok=True)
        instruments_and_map(drive, out / "drive.png")
        modes(drive, out / "modes_day.jpg", night=False)
        modes(drive, out / "modes_night.jpg", night=True)
        one(drive, out / "view.jpg", Wanted(*TILE, rich=True), Mode.AUTONOMOUS, "english")
        one(drive, out / "german.jpg", Wanted(*TILE, rich=True, large_text=True), Mode.TAKEOVER_REQUESTED, "german")
        video(drive, out / "drive.mp4")
        animation(out / "drive.mp4", out / "drive.webp")
    sizes = {name: (out / name).stat().st_size for name in MADE}
    print("\n".join(f"{name:<16} {size / 1e3:6.0f} kB" for name, size in sizes.items()))
    if max(sizes.values()) > LARGEST_BYTES or sum(sizes.values()) > ALL_BYTES:
        raise SystemExit(f"too large: {LARGEST_BYTES} bytes each, {ALL_BYTES} together")


if __name__ == "__main__":
    main()
