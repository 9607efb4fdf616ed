"""The page before a drive: what is connected, and what can be driven. Pure."""

from collections.abc import Sequence
from enum import Enum, auto
from typing import Final, NamedTuple

from simconsole.hud.draw import (
    ACTIVE,
    BACKGROUND,
    LINE,
    MUTED,
    PANEL,
    TEXT,
    Box,
    DrawItem,
    Polygon,
    Rect,
    Text,
    fit_cap_px,
    text_width_px,
)
from simconsole.hud.screen import DRIVING_ARCMIN, SECONDARY_ARCMIN, Screen

HINT: Final = "arrows: choose    Return: drive    Escape: leave"


class Offer(NamedTuple):
    """One line that can be chosen."""

    label: str
    note: str = ""  # what is connected, or why it cannot be chosen
    possible: bool = True


class StartPage(NamedTuple):
    """What is offered, and what is chosen of it."""

    cockpits: tuple[Offer, ...]
    places: tuple[Offer, ...]
    message: str = ""  # why the page is shown
    cockpit: int = 0
    place: int = 0
    column: int = 0  # 0: the cockpits, 1: the places


class Act(Enum):
    """What a person does with the page."""

    UP = auto()
    DOWN = auto()
    LEFT = auto()
    RIGHT = auto()


def opened(cockpits: Sequence[Offer], places: Sequence[Offer], message: str = "") -> StartPage:
    """Return the page as it opens: the first possible choice of each column."""
    first = next((number for number, offer in enumerate(cockpits) if offer.possible), 0)
    return StartPage(tuple(cockpits), tuple(places), message, cockpit=first)


def moved(page: StartPage, act: Act) -> StartPage:
    """Return the page after an act; what is not possible is passed over, and no list wraps around."""
    if act in (Act.LEFT, Act.RIGHT):
        return page._replace(column=int(act is Act.RIGHT))
    step = 1 if act is Act.DOWN else -1
    offers, now = (page.places, page.place) if page.column else (page.cockpits, page.cockpit)
    number = now + step
    while 0 <= number < len(offers) and not offers[number].possible:
        number += step
    if not 0 <= number < len(offers):
        return page
    return page._replace(place=number) if page.column else page._replace(cockpit=number)


def start_page(page: StartPage, screen: Screen) -> list[DrawItem]:
    """Return everything to draw, back to front, in pixels of `screen`."""
    area, unit = screen.content(), screen.px_per_arcmin
    cap = 1.8 * DRIVING_ARCMIN * unit
    items: list[DrawItem] = [Rect(Box(0.0, 0.0, screen.width_px, screen.height_px), BACKGROUND, "ground")]
    title = Text(area.x, area.y + 1.5 * cap, "simconsole", cap_px=2.0 * cap, colour=TEXT, role="title", anchor="l")
    items.append(title)
    if page.message:
        small = max(SECONDARY_ARCMIN * unit, fit_cap_px(page.message, DRIVING_ARCMIN * unit, area.w))
        said = _cut(page.message, small, area.w)
        items.append(
            Text(
                area.x, area.y + 4.2 * cap, said, cap_px=small, colour=MUTED, role="message", anchor="l",
                arcmin=SECONDARY_ARCMIN,
            )
        )  # fmt: skip
    lists = area.row(0.22, 0.92)
    columns = (lists.column(0.0, 0.55), lists.column(0.58, 1.0))
    items += _column(columns[0], "DRIVE WITH", page.cockpits, page.cockpit, page.column == 0, cap, unit)
    items += _column(columns[1], "WHERE", page.places, page.place, page.column == 1, cap, unit)
    hint = Text(area.cx, area.bottom - 0.6 * cap, HINT, cap_px=DRIVING_ARCMIN * unit, colour=MUTED, role="hint")
    return [*items, hint]


def _column(
    box: Box, heading: str, offers: Sequence[Offer], chosen: int, active: bool, cap: float, unit: float
) -> list[DrawItem]:
    """Return one list: the chosen line has a frame and a triangle, that of the list in use is filled."""
    items: list[DrawItem] = [
        Text(box.x, box.y + 0.5 * cap, heading, cap_px=0.85 * cap, colour=MUTED, role="heading", anchor="l")
    ]
    height = min(4.2 * cap, (box.h - 2.0 * cap) / max(1, len(offers)))
    for number, offer in enumerate(offers):
        line = Box(box.x, box.y + 2.0 * cap + number * height, box.w, 0.88 * height)
        if number == chosen:
            items.append(Rect(line, PANEL if active else BACKGROUND, "chosen"))
            items.append(Rect(line, ACTIVE if active else LINE, "chosen.frame", 0.0, max(2.0, 0.1 * cap)))
            x, y = line.x + 0.8 * cap, line.y + 0.33 * line.h
            corners = ((x, y - 0.45 * cap), (x + 0.7 * cap, y), (x, y + 0.45 * cap))
            items.append(Polygon(corners, ACTIVE if active else MUTED, "chosen.mark"))
        left, room = line.x + 2.2 * cap, line.w - 2.8 * cap
        shown = 0.85 * cap
        items.append(
            Text(
                left, line.y + 0.33 * line.h, _cut(offer.label, shown, room), cap_px=shown,
                colour=TEXT if offer.possible else MUTED, role="offer", anchor="l",
            )
        )  # fmt: skip
        if offer.note:
            small = 1.6 * SECONDARY_ARCMIN * unit
            items.append(
                Text(
                    left, line.y + 0.74 * line.h, _cut(offer.note, small, room), cap_px=small, colour=MUTED,
                    role="offer.note", anchor="l", arcmin=SECONDARY_ARCMIN,
                )
            )  # fmt: skip
    return items


def _cut(text: str, cap_px: float, width_px: float) -> str:
    """Return as much of `text` as fits; only what can be drawn."""
    plain = "".join(sign if " " <= sign <= "~" else "?" for sign in text)
    if text_width_px(plain, cap_px) <= width_px:
        return plain
    while plain and text_width_px(plain + "...", cap_px) > width_px:
        plain = plain[:-1]
    return plain.rstrip() + "..."
