"""One shape for each mode: whoever cannot tell the colours, or cannot read at a glance, still tells the modes apart."""

from simconsole.hud.draw import Arc, Box, Colour, DrawItem, Point, Polygon, Rect, around
from simconsole.values.signals import Mode


def mode_shape(mode: float, box: Box, colour: Colour, ground: Colour) -> list[DrawItem]:
    """Return the shape of `mode` inside a square box: a filled sign, its inner marks in `ground`.

    Parked: square with P's bar; manual: ring (a steering wheel); shared: half-filled ring; autonomous: hexagon;
    take over: triangle with a mark of exclamation; minimal risk: triangle on its tip; stopped: square outline with a
    bar; emergency stop: octagon with a cross. Unknown: diamond.
    """
    x, y, r = box.cx, box.cy, 0.5 * box.w
    role = "mode.shape"
    if mode == Mode.PARKED:
        return [Rect(box.inset(0.1 * r), colour, role, 0.2 * r), *_letter_p(box, ground)]
    if mode == Mode.MANUAL:
        return [
            Arc(x, y, outer=r, inner=0.74 * r, start_deg=0.0, end_deg=360.0, colour=colour, role=role),
            *_spokes(x, y, r, colour),
        ]
    if mode == Mode.SHARED:
        return [
            Arc(x, y, outer=r, inner=0.74 * r, start_deg=0.0, end_deg=360.0, colour=colour, role=role),
            Arc(x, y, outer=0.56 * r, inner=0.0, start_deg=0.0, end_deg=180.0, colour=colour, role=role),
        ]
    if mode == Mode.AUTONOMOUS:
        inner = Polygon(around(x, y, 0.52 * r, 6), ground, role)
        return [Polygon(around(x, y, r, 6), colour, role), inner, Polygon(around(x, y, 0.28 * r, 6), colour, role)]
    if mode == Mode.TAKEOVER_REQUESTED:
        return exclamation(box, colour, ground, role)
    if mode == Mode.MINIMAL_RISK:
        bar = Rect(Box(x - 0.42 * r, y - 0.42 * r, 0.84 * r, 0.2 * r), ground, role)
        return [Polygon(around(x, y - 0.15 * r, 1.1 * r, 3, 180.0), colour, role), bar]
    if mode == Mode.STOPPED:
        bar = Rect(Box(x - 0.45 * r, y - 0.14 * r, 0.9 * r, 0.28 * r), colour, role)
        return [Rect(box.inset(0.1 * r), colour, role, 0.2 * r, 0.2 * r), bar]
    if mode == Mode.EMERGENCY_STOP:
        return [Polygon(around(x, y, r, 8, 22.5), colour, role), *_cross(x, y, 0.45 * r, ground)]
    return [Polygon(around(x, y, r, 4), colour, role)]


def exclamation(box: Box, colour: Colour, ground: Colour, role: str) -> list[DrawItem]:
    """Return a warning triangle with an exclamation mark."""
    x, y, r = box.cx, box.cy, 0.5 * box.w
    stroke: tuple[Point, ...] = (
        (x - 0.13 * r, y - 0.42 * r),
        (x + 0.13 * r, y - 0.42 * r),
        (x + 0.08 * r, y + 0.22 * r),
        (x - 0.08 * r, y + 0.22 * r),
    )
    triangle = Polygon(around(x, y + 0.15 * r, 1.1 * r, 3), colour, role)
    return [
        triangle,
        Polygon(stroke, ground, role),
        Arc(x, y + 0.42 * r, outer=0.12 * r, inner=0.0, start_deg=0.0, end_deg=360.0, colour=ground, role=role),
    ]


def _spokes(x: float, y: float, r: float, colour: Colour) -> list[DrawItem]:
    hub = Arc(x, y, outer=0.24 * r, inner=0.0, start_deg=0.0, end_deg=360.0, colour=colour, role="mode.shape")
    across = Rect(Box(x - 0.8 * r, y - 0.09 * r, 1.6 * r, 0.18 * r), colour, "mode.shape")
    down = Rect(Box(x - 0.09 * r, y, 0.18 * r, 0.8 * r), colour, "mode.shape")
    return [hub, across, down]


def _letter_p(box: Box, colour: Colour) -> list[DrawItem]:
    x, y, r = box.cx, box.cy, 0.5 * box.w
    stem = Rect(Box(x - 0.3 * r, y - 0.5 * r, 0.2 * r, 1.0 * r), colour, "mode.shape")
    return [
        stem,
        Arc(
            x,
            y - 0.19 * r,
            outer=0.32 * r,
            inner=0.13 * r,
            start_deg=0.0,
            end_deg=180.0,
            colour=colour,
            role="mode.shape",
        ),
        *_bars(x, y, r, colour),
    ]


def _bars(x: float, y: float, r: float, colour: Colour) -> list[DrawItem]:
    top = Rect(Box(x - 0.15 * r, y - 0.51 * r, 0.16 * r, 0.19 * r), colour, "mode.shape")
    return [top, Rect(Box(x - 0.15 * r, y - 0.06 * r, 0.16 * r, 0.19 * r), colour, "mode.shape")]


def _cross(x: float, y: float, r: float, colour: Colour) -> list[DrawItem]:
    half = 0.24 * r
    bars: list[DrawItem] = []
    for sign in (1.0, -1.0):
        points = (
            (x - r - half, y - sign * (r - half)),
            (x - r + half, y - sign * (r + half)),
            (x + r + half, y + sign * (r - half)),
            (x + r - half, y + sign * (r + half)),
        )
        bars.append(Polygon(points, colour, "mode.shape"))
    return bars
