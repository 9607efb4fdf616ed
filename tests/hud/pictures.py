"""Views to lay out, and what was drawn of them."""

from typing import Any

from simconsole.hud.draw import PALETTE, Colour, DrawItem, Text
from simconsole.hud.layout import layout
from simconsole.hud.screen import LARGE_TEXT, Screen
from simconsole.hud.view import HudSettings, HudView
from simconsole.profiles.files.loader import load
from simconsole.profiles.view import LanguageProfile
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode

SCREENS = {
    "4:3": Screen(1400, 1050, 1.6, 2.2),
    "16:9": Screen(1920, 1080, 1.6, 2.0),
    "triple": Screen(4200, 1050, 4.8, 2.2),
}
SCREEN = SCREENS["4:3"]
LARGE = {name: screen._replace(text=LARGE_TEXT) for name, screen in SCREENS.items()}
GERMAN = HudSettings(language=load("languages", "german", LanguageProfile))


def in_mode(mode: Mode, **more: Any) -> HudView:
    return HudView(mode=float(mode), mode_label=mode_label(mode), reason_label="driver asked")._replace(**more)


def asked(stage: int, **more: Any) -> HudView:
    return in_mode(Mode.TAKEOVER_REQUESTED, takeover_stage=stage, **{"remaining_s": 7.2, **more})


def texts(items: list[DrawItem]) -> list[Text]:
    return [item for item in items if isinstance(item, Text)]


def by_role(items: list[DrawItem], role: str) -> list[DrawItem]:
    return [item for item in items if item.role == role]


def said(view: HudView, role: str) -> list[str]:
    return [item.text for item in texts(layout(view, SCREEN)) if item.role == role]


def colours(items: list[DrawItem], role: str) -> set[Colour]:
    return {item.colour for item in items if item.role == role}


def shape_of(item: DrawItem) -> tuple[object, ...]:
    """What is drawn, without its colours."""
    return tuple(value for value in item if value not in PALETTE)
