"""The panels beside and below the dial: pedals, steering and link, lamps."""

from typing import Final, Literal, NamedTuple

from simconsole.hud.captions import AUTOPILOT, CONSOLE, NOBODY, YOU
from simconsole.hud.draw import (
    ACTIVE,
    CAUTION,
    LINE,
    MUTED,
    PANEL,
    TEXT,
    Arc,
    Box,
    Colour,
    DrawItem,
    Polygon,
    Rect,
    Text,
    around,
    fit_cap_px,
    text_width_px,
)
from simconsole.hud.screen import DRIVING_ARCMIN, SECONDARY_ARCMIN
from simconsole.hud.shapes import exclamation
from simconsole.hud.view import HudView
from simconsole.values.labels import LINK_CONNECTING, LINK_DOWN, LINK_LOST, LINK_NOBODY, LINK_RETRYING, validity_label
from simconsole.values.signals import Validity
from simconsole.values.validity import is_trusted

Anchor = Literal["l", "c", "r"]

_LINK_LEVELS: Final = {
    LINK_NOBODY: "plain", LINK_LOST: "warn", LINK_CONNECTING: "warn", LINK_RETRYING: "warn", LINK_DOWN: "warn",
}  # fmt: skip
PEDALS: Final = "PEDALS"
STEERING: Final = "STEERING"
CLUTCH: Final = "CLUTCH"
BRAKE: Final = "BRAKE"
GAS: Final = "GAS"
LEFT: Final = "{degrees} deg L"
RIGHT: Final = "{degrees} deg R"
STRAIGHT: Final = "{degrees} deg"
LINK_TITLE: Final = "AUTOPILOT LINK"
LINK_ON: Final = "AUTOPILOT ON {commander}"
LIVE: Final = "LIVE"
SILENT: Final = "SILENT"
NONE: Final = "NONE"
NO_COMMAND: Final = "no command yet"
AGE: Final = "{age} ms old"
TOO_OLD: Final = "over 10 s old"
HAND_BRAKE: Final = "HAND BRAKE"
LAMPS: Final = ("WHEEL", PEDALS, "SHIFTER", "FORCE", "ENGINE", HAND_BRAKE, "CAN", "LINK")
RUNNING: Final = "running"
OFF: Final = "off"
ON: Final = "on"
DOWN: Final = "down"
LET_GO: Final = "let go"
CLIENTS: Final = "{count} clients"
ONE_CLIENT: Final = "1 client"
_FORCE_LEVELS: Final = {"none": "plain", "on": "good", "eased": "plain", "limit": "warn", "lost": "warn"}


def _panel(box: Box, title: str) -> list[DrawItem]:
    cap = min(0.030 * box.h, 0.05 * box.w)
    return [
        Rect(box, PANEL, "panel", 0.04 * box.w),
        Text(
            box.x + 0.07 * box.w,
            box.y + 0.065 * box.h,
            title,
            cap_px=cap,
            colour=MUTED,
            role="panel.title",
            anchor="l",
            arcmin=SECONDARY_ARCMIN,
        ),
    ]


def pedals(view: HudView, box: Box) -> list[DrawItem]:
    """Return the pedals in their order on the floor: the bar is what the car gets, the mark what the foot does."""
    items = _panel(box, view.say(PEDALS))
    rows = (
        (CLUTCH, view.clutch, view.driver_clutch),
        (BRAKE, view.brake, view.driver_brake),
        (GAS, view.throttle, view.driver_throttle),
    )[view.settings.is_robot :]  # which has no clutch
    widest = max((view.say(name) for name, _, _ in rows), key=lambda name: text_width_px(name, 1.0))
    inside = Box(box.x + 0.06 * box.w, box.y + 0.13 * box.h, 0.88 * box.w, 0.82 * box.h)
    for index, (name, value, foot) in enumerate(rows):
        column = inside.column(index / len(rows), (index + 1) / len(rows))
        cap = fit_cap_px(widest, 0.036 * column.h, 0.9 * column.w)
        items += _pedal(view, name, value, foot, cap, column)
    return items


def _pedal(view: HudView, name: str, value: float, foot: float, cap: float, box: Box) -> list[DrawItem]:
    width = 0.42 * box.w
    slot = Box(box.cx - 0.5 * width, box.y + 0.13 * box.h, width, 0.74 * box.h)
    number = "--" if view.stale else f"{100.0 * value:.0f}"
    role = f"pedal.{name.lower()}"
    ink = MUTED if view.stale else TEXT
    items: list[DrawItem] = [
        Text(
            box.cx,
            box.y + 0.055 * box.h,
            number,
            cap_px=1.25 * cap,
            colour=ink,
            role=f"{role}.number",
            anchor="c",
            arcmin=DRIVING_ARCMIN,
        ),
        Rect(slot, LINE, f"{role}.slot", 0.14 * width),
        Text(
            box.cx,
            box.bottom - 0.045 * box.h,
            view.say(name),
            cap_px=cap,
            colour=MUTED,
            role=f"{role}.name",
            anchor="c",
            arcmin=SECONDARY_ARCMIN,
        ),
    ]
    if view.stale:
        return items
    height = min(1.0, max(0.0, value)) * slot.h
    if height >= 1.0:
        items.append(Rect(Box(slot.x, slot.bottom - height, width, height), TEXT, f"{role}.bar", 0.14 * width))
    mark = slot.bottom - min(1.0, max(0.0, foot)) * slot.h
    reach = 0.3 * width
    points = ((slot.x - 0.08 * width, mark), (slot.x - 0.08 * width - reach, mark - 0.6 * reach))
    return [*items, Polygon((*points, (points[1][0], mark + 0.6 * reach)), MUTED, f"{role}.foot")]


def steering(view: HudView, box: Box) -> list[DrawItem]:
    """Return who steers, how far, and the link to the autopilot."""
    items = _panel(box, view.say(STEERING))
    inside = Box(box.x + 0.08 * box.w, box.y, 0.84 * box.w, box.h)
    items += _angle(view, inside.row(0.12, 0.40))
    items += share(view, inside.row(0.42, 0.66))
    line = Box(inside.x, box.y + 0.685 * box.h, inside.w, 2.0)
    return [*items, Rect(line, LINE, "panel.line"), *_link(view, inside.row(0.70, 0.96))]


def who_steers(view: HudView, box: Box) -> list[DrawItem]:
    """Return who steers and the link to the autopilot, as large as goes."""
    inside = Box(box.x + 0.06 * box.w, box.y, 0.88 * box.w, box.h)
    line = Rect(Box(inside.x, box.y + 0.5 * box.h, inside.w, 2.0), LINE, "panel.line")
    return [
        Rect(box, PANEL, "panel", 0.04 * box.w),
        *share(view, inside.row(0.05, 0.47)),
        line,
        *_link(view, inside.row(0.52, 0.96)),
    ]


def _angle(view: HudView, box: Box) -> list[DrawItem]:
    """Return the angle at the hand wheel: number and bar are what the car does, the mark is what the hands do."""
    degrees, lock_deg = view.hand_wheel_deg, view.settings.hand_wheel_lock_deg
    phrase = STRAIGHT if abs(degrees) < 0.5 else (LEFT if degrees > 0.0 else RIGHT)
    text = "--" if view.stale else view.say(phrase, degrees=f"{abs(degrees):.0f}")
    cap = fit_cap_px(view.say(RIGHT, degrees="000"), 0.24 * box.h, 0.88 * box.w)
    bar = Box(box.x, box.y + 0.62 * box.h, box.w, 0.16 * box.h)
    items: list[DrawItem] = [
        Text(
            box.cx,
            box.y + 0.3 * box.h,
            text,
            cap_px=cap,
            colour=MUTED if view.stale else TEXT,
            role="steering",
            anchor="c",
            arcmin=DRIVING_ARCMIN,
        ),
        Rect(bar, LINE, "steering.slot", 0.5 * bar.h),
    ]
    if not view.stale:
        x = _along(bar, degrees / lock_deg)
        left, right = min(x, bar.cx), max(x, bar.cx)
        if right - left >= 1.0:
            items.append(Rect(Box(left, bar.y, right - left, bar.h), TEXT, "steering.bar"))
    middle = Box(bar.cx - 0.08 * bar.h, bar.y - 0.4 * bar.h, max(2.0, 0.16 * bar.h), 1.8 * bar.h)
    items.append(Rect(middle, MUTED, "steering.middle"))
    if view.driver_hand_wheel_deg is not None and not view.stale:
        x, reach = _along(bar, view.driver_hand_wheel_deg / lock_deg), 0.8 * bar.h
        below = ((x, bar.bottom), (x - 0.6 * reach, bar.bottom + reach), (x + 0.6 * reach, bar.bottom + reach))
        items.append(Polygon(below, MUTED, "steering.hands"))
    return items


def _along(bar: Box, share: float) -> float:
    """Return where a share of the lock lies on a bar: 1 is its left end, -1 its right one."""
    return bar.cx - min(1.0, max(-1.0, share)) * 0.5 * bar.w


def share(view: HudView, box: Box) -> list[DrawItem]:
    """Return who steers: the person's part from the left, from the right that of whoever has the rest."""
    remote = min(1.0, max(0.0, view.remote_lateral))
    nobody = view.other_side == NOBODY
    bar = Box(box.x, box.y + 0.58 * box.h, box.w, 0.2 * box.h)
    you = "--" if view.stale or nobody else f"{100.0 * (1.0 - remote):.0f} %"
    other = "--" if view.stale or nobody else f"{100.0 * remote:.0f} %"
    cap = fit_cap_px(view.say(AUTOPILOT), 0.12 * box.h, 0.58 * box.w)
    top, below = box.y + 0.14 * box.h, box.y + 0.38 * box.h
    items = [
        _share_text(box.x, top, view.say(YOU), "share.label", "l", cap),
        _share_text(box.x, below, you, "share.you", "l", cap),
    ]
    if view.other_side and not view.stale:
        items.append(_share_text(box.right, top, view.say(view.other_side), "share.label", "r", cap))
        items.append(_share_text(box.right, below, other, "share.other", "r", cap))
    items.append(Rect(bar, LINE, "share.slot", 0.3 * bar.h))
    if view.stale or nobody:
        return items
    cut = bar.x + (1.0 - remote) * bar.w
    if cut - bar.x >= 1.0:
        items.append(Rect(Box(bar.x, bar.y, cut - bar.x, bar.h), TEXT, "share.person", 0.3 * bar.h))
    if bar.right - cut >= 1.0:
        colour = CAUTION if view.other_side == CONSOLE else ACTIVE
        items.append(Rect(Box(cut, bar.y, bar.right - cut, bar.h), colour, "share.remote", 0.3 * bar.h))
    return items


def _share_text(x: float, y: float, text: str, role: str, anchor: Anchor, cap: float) -> DrawItem:
    if role == "share.label":
        return Text(x, y, text, cap_px=cap, colour=MUTED, role=role, anchor=anchor, arcmin=SECONDARY_ARCMIN)
    return Text(x, y, text, cap_px=1.15 * cap, colour=TEXT, role=role, anchor=anchor, arcmin=DRIVING_ARCMIN)


def _link(view: HudView, box: Box) -> list[DrawItem]:
    state, age, colour = _link_label(view)
    text = view.say(state)
    side = 0.2 * box.h
    sign = Box(box.x, box.y + 0.48 * box.h - 0.5 * side, side, side)
    cap = fit_cap_px(view.say(SILENT), 0.17 * box.h, box.w - 1.6 * side)
    x = sign.right + 0.6 * side
    is_commanded = not view.stale and view.commander != "none"
    name = view.say(LINK_ON, commander=view.commander) if is_commanded else view.say(LINK_TITLE)
    widest = view.say(LINK_ON, commander="ROS")
    title = Text(
        box.x, box.y + 0.14 * box.h, name, cap_px=fit_cap_px(widest, 0.11 * box.h, box.w),
        colour=MUTED, role="link.title", anchor="l", arcmin=SECONDARY_ARCMIN,
    )  # fmt: skip
    return [
        title,
        *_link_shape(state, sign, colour),
        Text(
            x,
            box.y + 0.48 * box.h,
            text,
            cap_px=cap,
            colour=TEXT if state != "--" else MUTED,
            role="link",
            anchor="l",
            arcmin=DRIVING_ARCMIN,
        ),
        Text(
            x,
            box.y + 0.80 * box.h,
            age,
            cap_px=min(cap, 0.12 * box.h),
            colour=MUTED,
            role="link.age",
            anchor="l",
            arcmin=SECONDARY_ARCMIN,
        ),
    ]


def _link_label(view: HudView) -> tuple[str, str, Colour]:
    if view.stale:
        return "--", "--", MUTED
    if view.link_age_s is None:
        return NONE, view.say(NO_COMMAND), MUTED
    age = view.say(AGE, age=f"{1000.0 * view.link_age_s:.0f}") if view.link_age_s < 10.0 else view.say(TOO_OLD)
    return (SILENT, age, CAUTION) if view.link_age_s > view.settings.link_stale_s else (LIVE, age, ACTIVE)


def _link_shape(state: str, box: Box, colour: Colour) -> list[DrawItem]:
    if state == SILENT:
        return exclamation(box, colour, PANEL, "link.shape")
    inner = 0.0 if state == LIVE else 0.36 * box.w
    return [
        Arc(
            box.cx,
            box.cy,
            outer=0.5 * box.w,
            inner=inner,
            start_deg=0.0,
            end_deg=360.0,
            colour=colour,
            role="link.shape",
        )
    ]


class Lamp(NamedTuple):
    """One sign of the strip of lamps; its level is good, plain or warn."""

    name: str
    text: str
    level: str


def lamps(view: HudView) -> list[Lamp]:
    """Return the three devices, the wheel's motor, engine, hand brake, and CAN and bridge if any.

    A robot has neither gears nor engine nor hand brake.
    """
    robot = view.settings.is_robot
    shifter = (view.lever_label, "warn") if view.lever_label else _device(view.shifter_validity)
    states = [
        _device(view.wheel_validity),
        _device(view.pedals_validity),
        None if robot else shifter,
        (view.force, _FORCE_LEVELS[view.force]),
        None if robot else (RUNNING, "good") if view.engine_running else (OFF, "plain"),
        None if robot else _hand_brake(view),
        None if view.can_up is None else ((ON, "good") if view.can_up else (DOWN, "warn")),
        None if view.link is None else (_link_words(view), _LINK_LEVELS.get(view.link, "good")),
    ]
    return [Lamp(name, *state) for name, state in zip(LAMPS, states, strict=True) if state is not None]


def _link_words(view: HudView) -> str:
    """Return how the bridge stands; its worker counts the clients in English."""
    assert view.link is not None
    count, _, noun = view.link.partition(" ")
    return view.say(CLIENTS, count=count) if noun == "clients" else view.link


def status(view: HudView, box: Box, most: int = len(LAMPS)) -> list[DrawItem]:
    """Return the strip of lamps, `most` of them: first those that are not as they should be."""
    cells = lamps(view)
    if len(cells) > most:
        cells = sorted(cells, key=lambda lamp: lamp.level != "warn")[:most]
    items: list[DrawItem] = [Rect(box, PANEL, "status", 0.12 * box.h)]
    for index, lamp in enumerate(cells):
        cell = box.inset(0.01 * box.w).column(index / len(cells), (index + 1) / len(cells))
        items += lamp_cell(lamp, view, cell, box)
    return items


def _device(validity: float) -> tuple[str, str]:
    bad = validity in (Validity.STALE, Validity.LOST)
    return validity_label(validity), "warn" if bad else ("good" if is_trusted(validity) else "plain")


def _hand_brake(view: HudView) -> tuple[str, str]:
    """Return the text and the level of the hand brake's lamp.

    A lever that was lost reads as released, and so does one that is pulled before it was seen at rest. The lamp tells
    both, also while the console itself holds the brake on.
    """
    if view.handbrake_validity in (Validity.STALE, Validity.LOST):
        return _device(view.handbrake_validity)
    if view.handbrake_validity == Validity.UNKNOWN and is_trusted(view.wheel_validity):
        return LET_GO, "warn"
    return (ON, "warn") if view.handbrake > 0.05 else (OFF, "plain")


def lamp_cell(lamp: Lamp, view: HudView, cell: Box, box: Box) -> list[DrawItem]:
    """Return one lamp in its cell of a strip that is as high as `box`."""
    role = f"status.{lamp.name.lower().replace(' ', '_')}"
    name, text, level = view.say(lamp.name), view.say(lamp.text), lamp.level
    if view.stale:
        text, level = "--", "plain"
    label = fit_cap_px(max(name, view.say(HAND_BRAKE), key=len), 0.14 * box.h, 0.92 * cell.w)
    side = 0.22 * box.h
    x = cell.x + 0.04 * cell.w
    items: list[DrawItem] = [
        Text(
            x,
            box.y + 0.28 * box.h,
            name,
            cap_px=label,
            colour=MUTED,
            role=f"{role}.name",
            anchor="l",
            arcmin=SECONDARY_ARCMIN,
        )
    ]
    y = box.y + 0.68 * box.h
    if level != "plain":
        items += _lamp(level, Box(x, y - 0.5 * side, side, side), f"{role}.lamp")
        x += 1.35 * side
    cap = fit_cap_px(text, 0.19 * box.h, cell.right - x - 0.03 * cell.w)
    ink = CAUTION if level == "warn" else TEXT
    return [*items, Text(x, y, text, cap_px=cap, colour=ink, role=f"{role}.label", anchor="l", arcmin=DRIVING_ARCMIN)]


def _lamp(level: str, box: Box, role: str) -> list[DrawItem]:
    if level == "warn":
        return exclamation(box, CAUTION, PANEL, role)
    check = around(box.cx, box.cy, 0.36 * box.w, 24)
    return [Polygon(check, ACTIVE, role)]
