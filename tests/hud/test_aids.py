"""What keys lay over the picture can be read and stays on the screen, whatever the cockpit."""

import pytest

from simconsole.hud.aids import Aids, aid_panels
from simconsole.hud.draw import Text, bounds, contrast
from simconsole.hud.key_names import KEY_CODES, WindowKey, help_rows
from simconsole.hud.screen import LARGE_TEXT, Screen, fit
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.profiles.view import ENGLISH, LanguageProfile
from simconsole.values.key_codes import Key
from tests.hud.pictures import GERMAN, SCREENS

LINES = ("60 frames/s", "frame 16.7 ms, 99 %: 17.0 ms", "llvmpipe (LLVM 15.0.6, 256 bits)")
ALL = [*SCREENS.values(), fit(SCREENS["4:3"], 640, 480).screen, fit(SCREENS["4:3"], 1366, 706).screen]


@pytest.mark.parametrize("cockpit", ["keyboard", "t500rs_th8rs", "gamepad"])
@pytest.mark.parametrize("screen", [*ALL, *(screen._replace(text=LARGE_TEXT) for screen in ALL)])
@pytest.mark.parametrize("language", [ENGLISH, GERMAN.language], ids=["english", "german"])
def test_help_and_times_are_legible_and_inside(cockpit: str, screen: Screen, language: LanguageProfile) -> None:
    profile = load("devices", cockpit, CockpitProfile)
    rows = help_rows(profile, by_keyboard=cockpit == "keyboard", language=language)
    panels = aid_panels(Aids(help=rows, times=LINES), screen)
    assert len(panels) == 2
    safe = screen.safe()
    for panel in panels:
        ground = panel.items[0].colour
        for item in panel.items:
            box = bounds(item)
            for outer in (panel.box, safe):
                assert box.x >= outer.x - 0.01
                assert box.y >= outer.y - 0.01
                assert box.right <= outer.right + 0.01
                assert box.bottom <= outer.bottom + 0.01
            if isinstance(item, Text):
                assert item.cap_px >= item.arcmin * screen.px_per_arcmin - 1e-9
                assert contrast(item.colour, ground) >= 7.0


def test_lines_do_not_overlap() -> None:
    rows = help_rows(load("devices", "keyboard", CockpitProfile), by_keyboard=True)
    (panel,) = aid_panels(Aids(help=rows), SCREENS["4:3"])
    boxes = [bounds(item) for item in panel.items if isinstance(item, Text)]
    for number, one in enumerate(boxes):
        for other in boxes[number + 1 :]:
            apart = one.right <= other.x or other.right <= one.x or one.bottom <= other.y or other.bottom <= one.y
            assert apart


def test_the_help_tells_every_key_of_the_keyboard() -> None:
    rows = help_rows(load("devices", "keyboard", CockpitProfile), by_keyboard=True)
    told = {label for labels, _ in rows for label in labels.split(", ")}
    keys = {name.removeprefix("K_").capitalize() for name in KEY_CODES}
    assert told == keys | {key.removeprefix("K_") for key in WindowKey}
    assert len({words for _, words in rows}) == len(rows) == len(Key) + len(WindowKey)


def test_the_help_of_a_wheel_calls_its_buttons_by_their_labels() -> None:
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    rows = dict(help_rows(cockpit, by_keyboard=False))
    assert rows[cockpit.button_label("autonomous")] == "let the autopilot drive"
    assert "Left, A" not in rows
    assert rows["End"] == "end the drive"


def test_nothing_is_laid_over_unless_asked_for() -> None:
    assert aid_panels(Aids(), SCREENS["4:3"]) == ()
