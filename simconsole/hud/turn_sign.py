"""The navigation arrow: where the route turns next, and how far it is until then."""

import math
from typing import Final

from simconsole.hud.draw import PANEL, TEXT, Arc, Box, DrawItem, Point, Polygon, Rect, Text, fit_cap_px
from simconsole.hud.guidance import Ahead
from simconsole.hud.screen import DRIVING_ARCMIN
from simconsole.hud.view import HudView

NOW: Final = "now"
METRES: Final = "{metres} m"
KILOMETRES: Final = "{kilometres} km"
TURN_WIDTH_ARCMIN: Final = 380.0
TURN_HEIGHT_ARCMIN: Final = 130.0
"""Of the sign over the road, at which its texts have the size that they need (`check_screen`)."""
SHARPEST_RAD: Final = math.radians(140.0)
"""A turn round is drawn as a sharp one: its arrow would lie on its own stem."""
_NOW_M: Final = 5.0
_FINE_M: Final = 100.0
_COARSE_M: Final = 1000.0


def turn_panel(view: HudView, box: Box) -> list[DrawItem]:
    """Return the sign with a ground of its own, for where it stands over the road; nothing without a route."""
    if view.ahead is None or view.stale:
        return []
    inside = box.inset(0.1 * box.h)
    return [Rect(box, PANEL, "turn.ground", 0.12 * box.h), *turn_sign(view, view.ahead, inside)]


def turn_sign(view: HudView, next_turn: Ahead, box: Box) -> list[DrawItem]:
    """Return the arrow, and beside it the distance."""
    side = min(box.h, 0.45 * box.w)
    text = distance_label(view, next_turn.distance_m)
    left = box.x + 1.2 * side
    cap = fit_cap_px(text, 0.42 * box.h, box.right - left)
    return [
        *_shape(next_turn, Box(box.x, box.cy - 0.5 * side, side, side)),
        Text(left, box.cy, text, cap_px=cap, colour=TEXT, role="turn.distance", anchor="l", arcmin=DRIVING_ARCMIN),
    ]


def distance_label(view: HudView, distance_m: float) -> str:
    """Return a distance as a driver reads it: no finer than they can use it."""
    if distance_m < _NOW_M:
        return view.say(NOW)
    if distance_m < _COARSE_M:
        step_m = 10.0 if distance_m < _FINE_M else 50.0
        metres = max(step_m, step_m * round(distance_m / step_m))
        if metres < _COARSE_M:
            return view.say(METRES, metres=f"{metres:.0f}")
    return view.say(KILOMETRES, kilometres=view.number(0.001 * distance_m, 1))


def _shape(next_turn: Ahead, box: Box) -> list[DrawItem]:
    if next_turn.is_end:
        return _flag(box)
    angle = min(SHARPEST_RAD, max(-SHARPEST_RAD, next_turn.angle_rad))
    return _roundabout(angle, next_turn.exit, box) if next_turn.exit else _arrow(angle, box)


def _arrow(angle_rad: float, box: Box) -> list[DrawItem]:
    """Return a stem from below, and from its end an arm to where the route goes."""
    unit = 0.5 * box.h
    higher = max(0.0, -math.cos(angle_rad))  # an arm that leads back needs room below
    heart = (box.cx + 0.25 * unit * math.sin(angle_rad), box.cy + (0.15 - 0.8 * higher) * unit)
    joint = _ring(heart, 0.15 * unit, 0.0, "turn.arrow")
    stem = _bar((heart[0], box.bottom), heart, 0.3 * unit)
    return [Polygon(stem, TEXT, "turn.arrow"), joint, *_arm(heart, angle_rad, 0.0, unit)]


def _roundabout(angle_rad: float, number: int, box: Box) -> list[DrawItem]:
    """Return a ring with a stem from below, an arm to the exit, and the exit's number in its middle."""
    unit = 0.5 * box.h
    heart = (box.cx, box.cy)
    ring = _ring(heart, 0.6 * unit, 0.47 * unit, "turn.ring")
    stem = _bar((box.cx, box.bottom), (box.cx, box.cy + 0.55 * unit), 0.22 * unit)
    text = f"{min(number, 9)}"  # no roundabout has more
    cap = fit_cap_px(text, 0.56 * unit, 0.6 * unit)
    return [
        ring,
        Polygon(stem, TEXT, "turn.arrow"),
        *_arm(heart, angle_rad, 0.55 * unit, 1.05 * unit),
        Text(box.cx, box.cy, text, cap_px=cap, colour=TEXT, role="turn.exit", arcmin=DRIVING_ARCMIN),
    ]


def _ring(heart: Point, outer: float, inner: float, role: str) -> Arc:
    """Return a whole ring; a disc where `inner` is 0."""
    return Arc(
        heart[0], heart[1], outer=outer, inner=inner, start_deg=0.0, end_deg=360.0, colour=TEXT, role=role
    )  # fmt: skip


def _flag(box: Box) -> list[DrawItem]:
    """Return the sign for the end of the route."""
    left, width = box.x + 0.3 * box.w, 0.1 * box.w
    cloth = ((left, box.y), (box.x + 0.9 * box.w, box.y + 0.25 * box.h), (left, box.y + 0.5 * box.h))
    return [Rect(Box(left, box.y, width, box.h), TEXT, "turn.end"), Polygon(cloth, TEXT, "turn.end")]


def _arm(heart: Point, angle_rad: float, start: float, tip: float) -> list[DrawItem]:
    """Return a bar with a head, from `start` to `tip` off the heart; 0 rad is upwards, left positive."""
    along = (-math.sin(angle_rad), -math.cos(angle_rad))
    across = (-along[1], along[0])

    def at(away: float, beside: float) -> Point:
        return (
            heart[0] + away * along[0] + beside * across[0],
            heart[1] + away * along[1] + beside * across[1],
        )

    neck = 0.62 * tip
    bar = _bar(at(start, 0.0), at(neck + 0.02 * tip, 0.0), 0.3 * tip)
    head = (at(tip, 0.0), at(neck, 0.36 * tip), at(neck, -0.36 * tip))
    return [Polygon(bar, TEXT, "turn.arrow"), Polygon(head, TEXT, "turn.arrow")]


def _bar(start: Point, end: Point, width: float) -> tuple[Point, ...]:
    """Return a bar of some width from one point to another."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    length = math.hypot(dx, dy)
    aside = (-0.5 * width * dy / length, 0.5 * width * dx / length)
    return (
        (start[0] + aside[0], start[1] + aside[1]),
        (end[0] + aside[0], end[1] + aside[1]),
        (end[0] - aside[0], end[1] - aside[1]),
        (start[0] - aside[0], start[1] - aside[1]),
    )
