"""The instruments in the fewest rows: what stands below the road, so that the road has the rest of the screen."""

from typing import Final

from simconsole.hud.banner import DISTANCE, TIME
from simconsole.hud.dial import AUTO, NO_DATA, UP, indicator_arrows, is_over_red, limit_sign, turning
from simconsole.hud.draw import CAUTION, LINE, MUTED, PANEL, TEXT, WARNING_LINE, Box, DrawItem, Rect, Text, fit_cap_px
from simconsole.hud.panels import Lamp, lamp_cell, lamps, share
from simconsole.hud.screen import DRIVING_ARCMIN, SECONDARY_ARCMIN, SPEED_ARCMIN
from simconsole.hud.view import HudView

HEIGHT_ARCMIN: Final = 150.0
"""Height of the strip at which each of its texts has the size that it needs (`check_screen`)."""
RPM: Final = "{rpm} rpm"
_SHOWN_LAMPS: Final = 2


def strip(view: HudView, box: Box) -> list[DrawItem]:
    """Return speed, gear, engine speed, who steers, and what is not as it should be, side by side."""
    inside = box.inset(0.08 * box.h)
    sides = inside.column(0.52, 0.72)
    driven = [
        *limit_sign(view, inside.x + 0.197 * inside.w, inside.y + 0.42 * inside.h, 0.36 * inside.h),
        *_gear(view, inside.column(0.23, 0.31)),
        *_engine(view, inside.column(0.33, 0.49)),
    ]
    return [
        Rect(box, PANEL, "strip", 0.12 * box.h),
        *_speed(view, inside.column(0.0, 0.165)),
        *(turning(view, inside.column(0.23, 0.49)) if view.settings.is_robot else driven),
        *share(view, Box(sides.x, box.y, sides.w, box.h)),
        *_lamps(view, inside.column(0.74, 1.0)),
    ]


def _speed(view: HudView, box: Box) -> list[DrawItem]:
    if view.stale:
        text = view.say(NO_DATA)
        cap = fit_cap_px(text, 0.3 * box.h, box.w)
        return [Text(box.cx, box.cy, text, cap_px=cap, colour=MUTED, role="speed", arcmin=DRIVING_ARCMIN)]
    cap = fit_cap_px(view.speed_text, 0.50 * box.h, box.w)
    return [
        Text(
            box.cx, box.y + 0.36 * box.h, view.speed_text, cap_px=cap, colour=TEXT, role="speed",
            arcmin=SPEED_ARCMIN,
        ),
        Text(
            box.cx, box.y + 0.85 * box.h, view.speed_unit, cap_px=0.165 * box.h, colour=MUTED, role="speed.unit",
            arcmin=DRIVING_ARCMIN,
        ),
        *indicator_arrows(view, box.cx, box.y + 0.36 * box.h, 0.42 * box.w, 0.14 * box.h),
    ]  # fmt: skip


def _gear(view: HudView, box: Box) -> list[DrawItem]:
    side = min(box.w, 0.62 * box.h)
    frame = Box(box.cx - 0.5 * side, box.y + 0.05 * box.h, side, side)
    gear, ink = ("-", MUTED) if view.stale else (view.gear, TEXT)
    items: list[DrawItem] = [
        Rect(frame, LINE, "gear.frame", 0.14 * side, max(2.0, 0.04 * side)),
        Text(frame.cx, frame.cy, gear, cap_px=0.56 * side, colour=ink, role="gear", arcmin=DRIVING_ARCMIN),
    ]
    if view.automatic and not view.stale:
        text = view.say(AUTO)
        cap = fit_cap_px(text, 0.14 * box.h, box.w)
        items.append(
            Text(
                box.cx,
                box.y + 0.85 * box.h,
                text,
                cap_px=cap,
                colour=MUTED,
                role="gear.automatic",
                arcmin=SECONDARY_ARCMIN,
            )
        )
    elif is_over_red(view) and not view.stale:
        text = view.say(UP)
        cap = fit_cap_px(text, 0.165 * box.h, box.w)
        items.append(
            Text(box.cx, box.y + 0.85 * box.h, text, cap_px=cap, colour=CAUTION, role="shift", arcmin=DRIVING_ARCMIN)
        )
    return items


def _engine(view: HudView, box: Box) -> list[DrawItem]:
    """Return engine speed as number and bar; a line marks where it becomes too fast."""
    settings = view.settings
    turning = "--" if view.stale else f"{50.0 * round(view.rpm / 50.0):.0f}"
    text = view.say(RPM, rpm=turning)
    bar = Box(box.x, box.y + 0.62 * box.h, box.w, 0.2 * box.h)
    cap = fit_cap_px(view.say(RPM, rpm="0000"), 0.2 * box.h, box.w)
    items: list[DrawItem] = [
        Text(
            box.cx, box.y + 0.3 * box.h, text, cap_px=cap, colour=MUTED if view.stale else TEXT, role="rpm",
            arcmin=DRIVING_ARCMIN,
        ),
        Rect(bar, LINE, "rpm.slot", 0.3 * bar.h),
    ]  # fmt: skip
    if view.stale:
        return items
    width = min(1.0, view.rpm / settings.rpm_max) * bar.w
    if width >= 1.0:
        items.append(Rect(Box(bar.x, bar.y, width, bar.h), TEXT, "rpm.bar", 0.3 * bar.h))
    red = Box(
        bar.x + settings.rpm_red / settings.rpm_max * bar.w, bar.y - 0.3 * bar.h, max(2.0, 0.12 * bar.h), 1.6 * bar.h
    )
    return [*items, Rect(red, WARNING_LINE, "rpm.red")]


def _lamps(view: HudView, box: Box) -> list[DrawItem]:
    """Return what is not as it should be, the worst first; driving time and distance where all is well."""
    bad = [lamp for lamp in lamps(view) if lamp.level == "warn"][:_SHOWN_LAMPS]
    if not bad or view.stale:
        seconds = int(view.t_s)
        bad = [
            Lamp(TIME, f"{seconds // 60:02d}:{seconds % 60:02d}", "plain"),
            Lamp(DISTANCE, view.distance_text(1), "plain"),
        ]
    items: list[DrawItem] = []
    for index, lamp in enumerate(bad):
        items += lamp_cell(lamp, view, box.column(index / _SHOWN_LAMPS, (index + 1) / _SHOWN_LAMPS), box)
    return items
