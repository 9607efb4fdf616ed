"""The dial in the middle: engine speed on the ring, road speed in digits, the gear below."""

import math
from typing import Final

from simconsole.hud.draw import (
    ACTIVE,
    CAUTION,
    LINE,
    MUTED,
    PANEL,
    TEXT,
    WARNING_LINE,
    Arc,
    Box,
    Colour,
    DrawItem,
    Polygon,
    Rect,
    Text,
    at_clock,
    fit_cap_px,
)
from simconsole.hud.screen import DRIVING_ARCMIN, SECONDARY_ARCMIN, SPEED_ARCMIN
from simconsole.hud.turn_sign import turn_sign
from simconsole.hud.view import HudView

START_DEG: Final = -130.0
SWEEP_DEG: Final = 260.0
PIECE_DEG: Final = 20.0
INDICATOR_HZ: Final = 1.5
"""Direction indicators flash 90 times a minute (UN Regulation 48: 90 plus or minus 30)."""
THOUSAND_RPM: Final = "x1000 rpm"
NO_DATA: Final = "NO DATA"
AUTO: Final = "AUTO"
UP: Final = "UP"
FLAT: Final = -0.78
"""Height of the dial's flat foot below its centre, in radii (upwards positive)."""


def dial(view: HudView, box: Box) -> list[DrawItem]:
    """Return ring, needle, speed, gear and, in the two upper corners, the turn indicators; of a robot its speeds."""
    radius = min(0.5 * box.w, box.h / (1.0 - FLAT))
    cx, cy = box.cx, box.y + 0.5 * (box.h - (1.0 - FLAT) * radius) + radius
    if view.settings.is_robot:
        turn = Box(cx - 0.5 * radius, cy + 0.42 * radius, radius, 0.31 * radius)
        return [*_face(cx, cy, radius), *_speed(view, cx, cy, radius), *turning(view, turn)]
    return [
        *_face(cx, cy, radius),
        *_band(view, cx, cy, radius),
        *_scale(view, cx, cy, radius),
        *_speed(view, cx, cy, radius),
        *_turn(view, cx, cy, radius),
        *_gear(view, cx, cy, radius),
        *limit_sign(view, cx - 0.335 * radius, cy + 0.575 * radius, 0.135 * radius),
        *indicator_arrows(view, cx, cy - 0.86 * radius, 0.84 * radius, 0.16 * radius),
    ]


def _clock_deg(view: HudView, rpm: float) -> float:
    return START_DEG + SWEEP_DEG * min(1.0, max(0.0, rpm / view.settings.rpm_max))


def _face(cx: float, cy: float, radius: float) -> list[DrawItem]:
    """Return the dial's ground: a disc with a flat foot."""
    half = math.degrees(math.acos(FLAT))
    points = tuple(at_clock(cx, cy, radius, half * step / 90.0) for step in range(-90, 91))
    return [Polygon(points, PANEL, "dial.face")]


def _band(view: HudView, cx: float, cy: float, radius: float) -> list[DrawItem]:
    """Return the band that fills with the engine's speed, and the needle at its end."""
    end = START_DEG + SWEEP_DEG
    track = Arc(
        cx,
        cy,
        outer=0.90 * radius,
        inner=0.85 * radius,
        start_deg=START_DEG,
        end_deg=end,
        colour=LINE,
        role="dial.track",
    )
    if view.stale:
        return [track]
    clock = _clock_deg(view, view.rpm)
    colour = WARNING_LINE if view.rpm >= view.settings.rpm_red else TEXT
    needle = tuple(
        at_clock(cx, cy, distance * radius, clock + offset)
        for distance, offset in ((0.82, -0.9), (0.985, -0.45), (0.985, 0.45), (0.82, 0.9))
    )
    return [track, *_filled(cx, cy, radius, clock), Polygon(needle, colour, "dial.needle")]


def _filled(cx: float, cy: float, radius: float, clock_deg: float) -> list[DrawItem]:
    """Return the filled part of the band in pieces, so that only its last piece changes from frame to frame."""
    items: list[DrawItem] = []
    start = START_DEG
    while clock_deg - start >= 0.2:
        # Each full piece reaches a little under the next: no gap shows between their smoothed ends.
        end = min(clock_deg, start + PIECE_DEG)
        items.append(
            Arc(
                cx,
                cy,
                outer=0.90 * radius,
                inner=0.85 * radius,
                start_deg=start,
                end_deg=min(clock_deg, end + 0.4),
                colour=MUTED,
                role="dial.band",
            )
        )
        start += PIECE_DEG
    return items


def _scale(view: HudView, cx: float, cy: float, radius: float) -> list[DrawItem]:
    red = _clock_deg(view, view.settings.rpm_red)
    end = START_DEG + SWEEP_DEG
    items: list[DrawItem] = [
        Arc(
            cx,
            cy,
            outer=0.955 * radius,
            inner=0.925 * radius,
            start_deg=red,
            end_deg=end,
            colour=WARNING_LINE,
            role="dial.red",
        )
    ]
    for half in range(2 * int(view.settings.rpm_max // 1000.0) + 1):
        clock = _clock_deg(view, 500.0 * half)
        whole = half % 2 == 0
        colour = WARNING_LINE if clock >= red - 1e-6 else MUTED
        items.append(_tick(cx, cy, 0.925 * radius, (0.97 if whole else 0.95) * radius, clock, whole, colour))
        if whole:
            x, y = at_clock(cx, cy, 0.735 * radius, clock)
            items.append(
                Text(
                    x,
                    y,
                    f"{half // 2}",
                    cap_px=0.075 * radius,
                    colour=TEXT,
                    role="dial.number",
                    anchor="c",
                    arcmin=SECONDARY_ARCMIN,
                )
            )
    unit = Text(
        cx,
        cy - 0.59 * radius,
        view.say(THOUSAND_RPM),
        cap_px=0.055 * radius,
        colour=MUTED,
        role="dial.unit",
        anchor="c",
        arcmin=SECONDARY_ARCMIN,
    )
    return [*items, unit]


def _tick(cx: float, cy: float, inner: float, outer: float, clock_deg: float, whole: bool, colour: Colour) -> DrawItem:
    half_deg = 0.55 if whole else 0.3
    corners = ((inner, -half_deg), (outer, -half_deg), (outer, half_deg), (inner, half_deg))
    points = tuple(at_clock(cx, cy, distance, clock_deg + offset) for distance, offset in corners)
    return Polygon(points, colour, "dial.tick")


def _speed(view: HudView, cx: float, cy: float, radius: float) -> list[DrawItem]:
    if view.stale:
        text = view.say(NO_DATA)
        return [
            Text(
                cx,
                cy - 0.06 * radius,
                text,
                cap_px=fit_cap_px(text, 0.17 * radius, 1.15 * radius),
                colour=MUTED,
                role="speed",
                anchor="c",
                arcmin=DRIVING_ARCMIN,
            )
        ]
    return [
        Text(
            cx,
            cy - 0.06 * radius,
            view.speed_text,
            cap_px=fit_cap_px(view.speed_text, 0.42 * radius, 1.5 * radius),
            colour=TEXT,
            role="speed",
            anchor="c",
            arcmin=SPEED_ARCMIN,
        ),
        Text(
            cx,
            cy + 0.28 * radius,
            view.speed_unit,
            cap_px=0.07 * radius,
            colour=MUTED,
            role="speed.unit",
            anchor="c",
            arcmin=DRIVING_ARCMIN,
        ),
    ]


def turning(view: HudView, box: Box) -> list[DrawItem]:
    """Return how fast a robot turns, in the middle of a box."""
    if view.stale:
        return []
    cap = fit_cap_px("+000 °/s", 0.4 * box.h, box.w)
    return [Text(box.cx, box.cy, view.turn_text, cap_px=cap, colour=TEXT, role="turning", arcmin=DRIVING_ARCMIN)]


def _turn(view: HudView, cx: float, cy: float, radius: float) -> list[DrawItem]:
    """Return the navigation arrow above the speed."""
    if view.stale or view.ahead is None:
        return []
    return turn_sign(view, view.ahead, Box(cx - 0.36 * radius, cy - 0.54 * radius, 0.72 * radius, 0.245 * radius))


def _gear(view: HudView, cx: float, cy: float, radius: float) -> list[DrawItem]:
    side = 0.31 * radius
    box = Box(cx - 0.5 * side, cy + 0.42 * radius, side, side)
    gear = "-" if view.stale else view.gear
    ink = MUTED if view.stale else TEXT
    items: list[DrawItem] = [
        Rect(box, LINE, "gear.frame", 0.14 * side, max(2.0, 0.02 * radius)),
        Text(box.cx, box.cy, gear, cap_px=0.56 * side, colour=ink, role="gear", anchor="c", arcmin=DRIVING_ARCMIN),
    ]
    if view.automatic and not view.stale:
        x = box.right + 0.07 * radius
        items.append(
            Text(
                x,
                box.cy,
                view.say(AUTO),
                cap_px=0.06 * radius,
                colour=MUTED,
                role="gear.automatic",
                anchor="l",
                arcmin=SECONDARY_ARCMIN,
            )
        )
    elif is_over_red(view) and not view.stale:
        items += _shift_up(view, Box(box.right + 0.07 * radius, box.cy - 0.06 * radius, 0.12 * radius, 0.12 * radius))
    return items


def is_over_red(view: HudView) -> bool:
    """Return whether a gear above the one that is in is asked for: not from neutral, reverse or the highest."""
    has_higher = view.gear.isdigit() and int(view.gear) < view.settings.top_gear
    return has_higher and view.rpm >= view.settings.rpm_red


def _shift_up(view: HudView, box: Box) -> list[DrawItem]:
    arrow = ((box.cx, box.y), (box.right, box.bottom), (box.x, box.bottom))
    label = Text(
        box.right + 0.3 * box.w,
        box.cy,
        view.say(UP),
        cap_px=0.6 * box.h,
        colour=CAUTION,
        role="shift",
        anchor="l",
        arcmin=DRIVING_ARCMIN,
    )
    return [Polygon(arrow, CAUTION, "shift.arrow"), label]


def limit_sign(view: HudView, cx: float, cy: float, radius: float) -> list[DrawItem]:
    """Return the speed limit as its road sign, a number in a ring; nothing where there is none, or no data."""
    if view.stale or view.limit_kmh <= 0:
        return []
    text = f"{view.limit_kmh}"
    ring = Arc(
        cx, cy, outer=radius, inner=0.84 * radius, start_deg=0.0, end_deg=360.0, colour=WARNING_LINE, role="limit.ring"
    )
    cap = fit_cap_px(text, 0.8 * radius, 1.35 * radius)
    return [ring, Text(cx, cy, text, cap_px=cap, colour=TEXT, role="limit", arcmin=DRIVING_ARCMIN)]


def indicator_arrows(view: HudView, cx: float, y: float, apart: float, reach: float) -> list[DrawItem]:
    """Return the arrows that flash with the lamps outside: `apart` from `cx`, one or both."""
    if view.stale or view.settings.is_robot or not lamps_on(view.t_s):
        return []
    both = view.hazard_lights > 0.0
    items: list[DrawItem] = []
    for name, side in (("left", -1.0), ("right", 1.0)):
        if both or side * view.turn_indicators < 0.0:
            items.append(_arrow(cx + side * apart, y, side * reach, f"indicator.{name}"))
    return items


def _arrow(x: float, y: float, reach: float, role: str) -> DrawItem:
    """Return an arrow about (x, y) that points along `reach`."""
    half, neck = abs(reach), 0.45 * abs(reach)
    points = (
        (x + reach, y), (x, y - half), (x, y - neck), (x - reach, y - neck),
        (x - reach, y + neck), (x, y + neck), (x, y + half),
    )  # fmt: skip
    return Polygon(points, ACTIVE, role)


def lamps_on(t_s: float) -> bool:
    """Return whether flashing lamps are lit at this time of the drive."""
    return math.floor(2.0 * INDICATOR_HZ * t_s) % 2 == 0
