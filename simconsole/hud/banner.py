"""Who drives, and the one alert that counts now."""

import math
from enum import IntEnum
from typing import Final

from simconsole.hud.draw import (
    ACTIVE,
    BACKGROUND,
    CAUTION,
    DANGER,
    INK,
    LINE,
    MUTED,
    PANEL,
    TEXT,
    Box,
    Colour,
    DrawItem,
    Rect,
    Text,
    fit_cap_px,
    text_width_px,
)
from simconsole.hud.screen import DRIVING_ARCMIN, SECONDARY_ARCMIN, Screen
from simconsole.hud.shapes import exclamation, mode_shape
from simconsole.hud.view import HudView
from simconsole.values.signals import Mode

MODE_UNKNOWN: Final = "MODE UNKNOWN"
TIME: Final = "TIME"
DISTANCE: Final = "DISTANCE"
FLASH_HZ: Final = 2.0
"""Only escalated alerts flash, between 1 and 5 Hz."""


class Alert(IntEnum):
    """All alerts, the weakest first: only the strongest is shown (rule 13)."""

    NONE = 0
    NOTICE = 1
    REFUSED = 2
    RECORDING_FAILED = 3
    STOPPED = 4
    TAKE_OVER = 5
    MINIMAL_RISK = 6
    TAKE_OVER_NOW = 7
    EMERGENCY = 8
    NO_DATA = 9


ONE_SCREEN: Final = (Alert.NOTICE, Alert.REFUSED)
"""They stand before the driver only; all others span every screen."""
ALERT_LABELS: Final[dict[Alert, tuple[str, str]]] = {
    Alert.RECORDING_FAILED: ("RECORDING FAILED", "drive is not kept"),
    Alert.STOPPED: ("STOPPED", ""),
    Alert.TAKE_OVER: ("TAKE OVER", ""),
    Alert.MINIMAL_RISK: ("CAR IS STOPPING", ""),
    Alert.TAKE_OVER_NOW: ("TAKE OVER NOW", ""),
    Alert.EMERGENCY: ("EMERGENCY STOP", ""),
    Alert.NO_DATA: ("NO DATA", "display is blind"),
}
"""A headline and what to do, at most seven words together (rule 14); where it is empty the view says what to do."""


def alert_of(view: HudView) -> Alert:
    """Return the one alert to show."""
    found = Alert.NOTICE if view.notice_label else Alert.NONE
    if view.refusal_label:
        found = Alert.REFUSED
    if view.recording_failed:
        found = Alert.RECORDING_FAILED
    if view.mode == Mode.STOPPED:
        found = Alert.STOPPED
    if view.mode == Mode.TAKEOVER_REQUESTED:
        found = Alert.TAKE_OVER_NOW if view.takeover_stage >= 2 else Alert.TAKE_OVER
    if view.mode == Mode.MINIMAL_RISK:
        found = Alert.MINIMAL_RISK
    if view.mode == Mode.EMERGENCY_STOP:
        found = Alert.EMERGENCY
    return Alert.NO_DATA if view.stale else found


def flash_on(t_s: float) -> bool:
    """Return whether a flashing field is in its strong half."""
    return math.floor(2.0 * FLASH_HZ * t_s) % 2 == 0


def _field(view: HudView, alert: Alert) -> tuple[Colour, Colour]:
    """Return ground and ink of an alert's field."""
    if alert in (Alert.TAKE_OVER_NOW, Alert.EMERGENCY):
        return (DANGER, TEXT) if flash_on(view.t_s) else (TEXT, DANGER)
    if alert is Alert.MINIMAL_RISK:
        return DANGER, TEXT
    if alert in (Alert.TAKE_OVER, Alert.RECORDING_FAILED):
        return CAUTION, INK
    return (LINE, TEXT) if alert is Alert.NO_DATA else (PANEL, CAUTION)


def banner(view: HudView, alert: Alert, box: Box) -> list[DrawItem]:
    """Return the mode: its shape, its label, and why it is so. Always there, always in this place (rule 4)."""
    if view.stale:
        return [
            Rect(box, PANEL, "banner", 0.12 * box.h),
            Text(
                box.cx,
                box.cy,
                view.say(MODE_UNKNOWN),
                cap_px=0.3 * box.h,
                colour=MUTED,
                role="mode.label",
                arcmin=DRIVING_ARCMIN,
            ),
        ]
    strong = alert in (Alert.TAKE_OVER_NOW, Alert.EMERGENCY, Alert.MINIMAL_RISK)
    ground, ink = _field(view, alert) if strong else (PANEL, TEXT)
    accent = ink if strong else _accent(view.mode)
    side = 0.68 * box.h
    shape = Box(box.x + 0.28 * box.h, box.cy - 0.5 * side, side, side)
    left = shape.right + 0.3 * box.h
    cap = fit_cap_px(view.mode_label, 0.36 * box.h, 0.56 * box.w)
    items: list[DrawItem] = [Rect(box, ground, "banner", 0.12 * box.h)]
    if not strong:
        items.append(Rect(Box(box.x, box.y, 0.07 * box.h, box.h), accent, "banner.edge"))
    items += mode_shape(view.mode, shape, accent, ground)
    items.append(
        Text(
            left, box.cy, view.mode_label, cap_px=cap, colour=ink, role="mode.label", anchor="l", arcmin=DRIVING_ARCMIN
        )
    )
    room = box.right - 0.3 * box.h - left - 1.02 * 0.56 * box.w
    if view.reason_label:
        field = Box(box.right - 0.3 * box.h - room, box.y, room, box.h)
        items += _reason(view.reason_label, field, ink if strong else MUTED)
    return items


def _reason(text: str, box: Box, ink: Colour) -> list[DrawItem]:
    """Return the reason, on one line or two."""
    lines = [text]
    half = fit_cap_px(text, 0.15 * box.h, box.w)
    if half < 0.15 * box.h:
        parts = text.split()
        cut = min(range(1, len(parts)), key=lambda i: abs(len(" ".join(parts[:i])) - len(" ".join(parts[i:]))))
        lines = [" ".join(parts[:cut]), " ".join(parts[cut:])]
    cap = min(fit_cap_px(line, 0.15 * box.h, box.w) for line in lines)
    first = box.cy - 0.9 * cap * (len(lines) - 1)
    return [
        Text(
            box.right,
            first + 1.8 * cap * index,
            line,
            cap_px=cap,
            colour=ink,
            role="reason",
            anchor="r",
            arcmin=DRIVING_ARCMIN,
        )
        for index, line in enumerate(lines)
    ]


def _accent(mode: float) -> Colour:
    if mode in (Mode.AUTONOMOUS, Mode.SHARED):
        return ACTIVE
    return CAUTION if mode == Mode.TAKEOVER_REQUESTED else TEXT


def slot(view: HudView, alert: Alert, box: Box, screen: Screen) -> list[DrawItem]:
    """Return the alert, or nothing. A take-over spans every screen; the text stands on each of them."""
    if alert is Alert.NONE:
        return _trip(view, box)
    if alert in ONE_SCREEN:
        return _line(view.refusal_label or view.notice_label, box)
    ground, ink = _field(view, alert)
    safe = screen.safe()
    items: list[DrawItem] = [Rect(Box(safe.x, box.y, safe.w, box.h), ground, "alert", 0.1 * box.h)]
    for panel in screen.panels():
        items += _headline(view, alert, Box(panel.x, box.y, panel.w, box.h), ink, ground)
    return items


def _trip(view: HudView, box: Box) -> list[DrawItem]:
    """Return driving time and distance, shown in the alert's place while there is no alert."""
    seconds = int(view.t_s)
    cells = (
        (view.say(TIME), f"{seconds // 60:02d}:{seconds % 60:02d}"),
        (view.say(DISTANCE), view.distance_text(2)),
    )
    items: list[DrawItem] = [Rect(box, PANEL, "trip", 0.12 * box.h)]
    for index, (name, text) in enumerate(cells):
        x = box.x + (0.3 * box.h if index == 0 else 0.5 * box.w)
        cap = 0.17 * box.h
        value = x + text_width_px(name, cap) + 0.25 * box.h
        items.append(
            Text(x, box.cy, name, cap_px=cap, colour=MUTED, role="trip.name", anchor="l", arcmin=SECONDARY_ARCMIN)
        )
        items.append(
            Text(
                value,
                box.cy,
                text,
                cap_px=0.28 * box.h,
                colour=TEXT,
                role="trip.value",
                anchor="l",
                arcmin=DRIVING_ARCMIN,
            )
        )
    return items


def _headline(view: HudView, alert: Alert, box: Box, ink: Colour, ground: Colour) -> list[DrawItem]:
    head, todo = map(view.say, ALERT_LABELS[alert])
    todo = todo or view.todo_label
    if alert in (Alert.RECORDING_FAILED, Alert.STOPPED, Alert.EMERGENCY):  # these last: answers must stay visible
        todo = view.refusal_label or view.notice_label or todo
    side = 0.62 * box.h
    items = exclamation(Box(box.x + 0.3 * box.h, box.y + 0.12 * box.h, side, side), ink, ground, "alert.shape")
    left = box.x + 0.3 * box.h + side + 0.3 * box.h
    counted = alert in (Alert.TAKE_OVER, Alert.TAKE_OVER_NOW)
    room = box.right - left - (1.3 if counted else 0.3) * box.h
    cap = fit_cap_px(head, 0.32 * box.h, room)
    items.append(
        Text(
            left,
            box.y + 0.29 * box.h,
            head,
            cap_px=cap,
            colour=ink,
            role="alert.label",
            anchor="l",
            arcmin=DRIVING_ARCMIN,
        )
    )
    if todo:
        items.append(
            Text(
                left,
                box.y + 0.67 * box.h,
                todo,
                cap_px=fit_cap_px(todo, 0.17 * box.h, room),
                colour=ink,
                role="alert.todo",
                anchor="l",
                arcmin=DRIVING_ARCMIN,
            )
        )
    return items + (_countdown(view, box, ink) if counted else [])


def _countdown(view: HudView, box: Box, ink: Colour) -> list[DrawItem]:
    """Return the seconds left, as a number and as a bar."""
    seconds = f"{math.ceil(view.remaining_s)}"
    inside = box.inset(0.3 * box.h)
    part = min(1.0, view.remaining_s / view.settings.takeover_window_s)
    items: list[DrawItem] = [
        Text(
            inside.right,
            box.y + 0.44 * box.h,
            seconds,
            cap_px=0.52 * box.h,
            colour=ink,
            role="alert.countdown",
            anchor="r",
            arcmin=DRIVING_ARCMIN,
        )
    ]
    if part * inside.w >= 1.0:
        items.append(Rect(Box(inside.x, box.y + 0.87 * box.h, part * inside.w, 0.06 * box.h), ink, "alert.bar"))
    return items


def _line(text: str, box: Box) -> list[DrawItem]:
    field = box.row(0.1, 0.9)
    side = 0.6 * field.h
    sign = Box(field.x + 0.4 * field.h, field.cy - 0.5 * side, side, side)
    left = sign.right + 0.3 * field.h
    cap = fit_cap_px(text, 0.26 * field.h, field.right - left - 0.3 * field.h)
    return [
        Rect(field, PANEL, "alert", 0.12 * field.h),
        Rect(field, CAUTION, "alert.edge", 0.12 * field.h, max(2.0, 0.03 * field.h)),
        *exclamation(sign, CAUTION, BACKGROUND, "alert.shape"),
        Text(left, field.cy, text, cap_px=cap, colour=TEXT, role="alert.label", anchor="l", arcmin=DRIVING_ARCMIN),
    ]
