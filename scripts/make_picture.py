"""The picture of README.md, from a recorded drive: `python scripts/make_picture.py BUNDLE docs/images/drive.png`.

Left the driver's instruments as the window draws them, right the map of the report: both by the functions that the
console itself uses.
"""

import argparse
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from simconsole.evaluation.metrics.drive_metrics import mode_changes
from simconsole.evaluation.metrics.table import drive_of
from simconsole.evaluation.metrics.track import track
from simconsole.evaluation.report.figure_map import draw_map
from simconsole.evaluation.report.figures import STYLE
from simconsole.hud.window.raster import snapshot_png
from simconsole.recording.bundles.bundle import open_bundle
from simconsole.recording.bundles.replay_bundle import recorded_session
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world

HEIGHT_PX = 540
MAP_INCH = (9.2, 7.4)
"""As in the report, where its words fit."""


def scaled(image: Image.Image) -> Image.Image:
    """Return the image at the picture's height."""
    return image.convert("RGB").resize((image.width * HEIGHT_PX // image.height, HEIGHT_PX), Image.Resampling.LANCZOS)


def main() -> None:
    """Read the bundle, draw both halves, write the picture."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bundle", type=Path)
    parser.add_argument("picture", type=Path)
    parser.add_argument("--at", type=float, default=60.0, metavar="S", help="moment that the instruments show")
    given = parser.parse_args()
    bundle = open_bundle(given.bundle)
    resolved, table = recorded_session(bundle), bundle.log.table()
    with tempfile.TemporaryDirectory() as folder:
        left, right = Path(folder) / "instruments.png", Path(folder) / "map.png"
        index = int(np.searchsorted(table.ticks, given.at * table.tick_hz))
        snapshot_png(Snapshot(int(table.ticks[index]), table.tick_hz, table.vectors[index]), left)
        drive = drive_of(table.vectors, table.columns, table.tick_hz, int(table.ticks[0]))
        course = None if resolved.world is None else open_world(resolved.world).route
        way = track(drive, course)
        style: dict[Any, Any] = STYLE | {"axes.grid": False}
        with rc_context(style):
            figure = Figure(figsize=MAP_INCH, dpi=200, layout="constrained")
            FigureCanvasAgg(figure)
            draw_map(figure, drive, way, mode_changes(drive, way), course)
            figure.savefig(right)
        halves = [scaled(Image.open(half)) for half in (left, right)]
    picture = Image.new("RGB", (sum(half.width for half in halves), HEIGHT_PX))
    picture.paste(halves[0], (0, 0))
    picture.paste(halves[1], (halves[0].width, 0))
    given.picture.parent.mkdir(parents=True, exist_ok=True)
    picture.save(given.picture, optimize=True)


if __name__ == "__main__":
    main()
