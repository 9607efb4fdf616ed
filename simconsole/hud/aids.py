"""What a key lays over the picture: the help for keys and buttons, and the frame times. Pure."""

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

from simconsole.hud.draw import MUTED, PANEL, TEXT, Box, DrawItem, Rect, Text, text_width_px
from simconsole.hud.screen import DRIVING_ARCMIN, SECONDARY_ARCMIN, Screen

LINE: Final = 1.9  # of a capital's height, from line to line
COLUMNS: Final = 2


class Aids(NamedTuple):
    """Which of them are shown."""

    help: tuple[tuple[str, str], ...] = ()  # what each key or button does; none: not shown
    times: tuple[str, ...] = ()  # lines; none: not shown


NO_AIDS: Final = Aids()


class Panel(NamedTuple):
    """A part of the screen that hides what is below it."""

    box: Box
    items: tuple[DrawItem, ...]


def aid_panels(aids: Aids, screen: Screen) -> tuple[Panel, ...]:
    """Return what lies over the picture."""
    helped = (help_panel(aids.help, screen),) if aids.help else ()
    return (*helped, *((times_panel(aids.times, screen),) if aids.times else ()))


def help_panel(rows: Sequence[tuple[str, str]], screen: Screen) -> Panel:
    """Return the help: what each key or button does, in two columns in the middle of the driver's screen."""
    area = screen.content()
    lines = math.ceil(len(rows) / COLUMNS)
    widest = max(text_width_px(label, 1.0) for label, _ in rows)
    words = max(text_width_px(text, 1.0) for _, text in rows)
    width = COLUMNS * (widest + words + 1.5) + 1.5 * (COLUMNS - 1) + 3.0  # in capitals' heights
    height = LINE * lines + 2.0
    cap = min(1.3 * DRIVING_ARCMIN * screen.px_per_arcmin, area.w / width, area.h / height)
    box = Box(area.cx - 0.5 * width * cap, area.cy - 0.5 * height * cap, width * cap, height * cap)
    items: list[DrawItem] = [Rect(box, PANEL, "help")]
    for number, (label, text) in enumerate(rows):
        column, line = divmod(number, lines)
        left = box.x + cap * (1.5 + column * (widest + words + 3.0))
        y = box.y + cap * (1.0 + LINE * (line + 0.5))
        items += [
            Text(left, y, label, cap_px=cap, colour=TEXT, role="help.key", anchor="l", arcmin=SECONDARY_ARCMIN),
            Text(
                left + cap * (widest + 1.5), y, text, cap_px=cap, colour=MUTED, role="help.words", anchor="l",
                arcmin=SECONDARY_ARCMIN,
            ),
        ]  # fmt: skip
    return Panel(box, tuple(items))


def times_panel(lines: Sequence[str], screen: Screen) -> Panel:
    """Return the frame times, on the left below the messages: for who sets up the machine."""
    area, cap = screen.content(), SECONDARY_ARCMIN * screen.px_per_arcmin
    width = max(text_width_px(line, cap) for line in lines) + 2.0 * cap
    top = area.y + 0.28 * area.h
    box = Box(area.x, top, width, cap * (LINE * len(lines) + 1.0))
    texts = (
        Text(
            box.x + cap, top + cap * (0.5 + LINE * (number + 0.5)), line, cap_px=cap, colour=TEXT, role="frame_times",
            anchor="l", arcmin=SECONDARY_ARCMIN,
        )
        for number, line in enumerate(lines)
    )  # fmt: skip
    return Panel(box, (Rect(box, PANEL, "frame_times"), *texts))
