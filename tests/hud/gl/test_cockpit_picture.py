import numpy as np
import pytest

from simconsole.hud.draw import Box, Text, bounds, contrast
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import view_scene
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.driver_view.views import looks
from simconsole.hud.gl.cockpit_picture import CockpitPicture, road_parts
from simconsole.hud.gl.context import is_software
from simconsole.hud.guidance import Ahead
from simconsole.hud.language import say
from simconsole.hud.layout import layout, panels_over_view
from simconsole.hud.screen import LARGE_TEXT, Screen, fit, fit_span
from simconsole.hud.view import HudSettings, HudView
from simconsole.profiles.view import DriverViewProfile
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from tests.hud.gl.pictures import Pixels, context, pixels, target
from tests.hud.pictures import GERMAN

SIZES = ((640, 480), (1366, 768), (1400, 1050), (1920, 1080))
SCENE = view_scene(None, (), Size(3.99, 1.75, 1.45, 0.75, 2.5))
MANUAL = HudView(mode=float(Mode.MANUAL), mode_label=mode_label(Mode.MANUAL), shown_kmh=47, engine_running=True)


def screen_of_size(width_px: int, height_px: int) -> Screen:
    return Screen(width_px, height_px, 1.6, 2.2, has_view=True)


def cockpit(screen: Screen, profile: DriverViewProfile | None = None) -> CockpitPicture:
    return CockpitPicture(
        context(), SCENE, profile or DriverViewProfile(), fit(screen, screen.width_px, screen.height_px), 15.0
    )


def shown(picture: CockpitPicture, screen: Screen, view: HudView) -> Pixels:
    framebuffer = target(screen.width_px, screen.height_px)
    picture.draw(framebuffer, ShownVehicle(), view)
    return pixels(framebuffer)


def luminances(picture: Pixels) -> np.ndarray:
    linear = (picture / 255.0) ** 2.2
    return np.asarray(linear @ np.array((0.2126, 0.7152, 0.0722)))


def capitals_px(picture: Pixels, ground: int) -> int:
    """The height in pixels of what stands out from a panel that is `ground` bright: its rows of text."""
    bright = picture.astype(int).sum(axis=2) > ground
    rows = np.nonzero(bright.any(axis=1))[0]
    return int(rows[-1] - rows[0] + 1)


@pytest.mark.parametrize("size", SIZES)
def test_the_speed_is_large_and_clear_enough_at_any_resolution(size: tuple[int, int]) -> None:
    """Rules 1 and 2 from pixels: digits of 60 minutes of arc, contrast of at least 7."""
    screen = screen_of_size(*size)
    picture = shown(cockpit(screen), screen, MANUAL)
    strip = panels_over_view(MANUAL, screen)[-1]
    part = picture[int(strip.y) : int(strip.y + 0.4 * strip.h), : int(0.25 * size[0])]
    assert capitals_px(part, 600) >= 60.0 * screen.px_per_arcmin - 1.0
    light = luminances(part)
    assert (light.max() + 0.05) / (np.median(light) + 0.05) > 7.0
    assert contrast((242, 245, 247), (18, 24, 33)) > 7.0


def told(settings: HudSettings) -> tuple[HudView, ...]:
    """Views with every kind of text over the road: a take-over, a notice, lamps, the next turn, no data."""
    driving = MANUAL._replace(
        settings=settings, mode_label=say(settings.language, MANUAL.mode_label), limit_kmh=50, gear="3", rpm=2300.0,
        automatic=True, remote_lateral=0.5, other_side="AUTOPILOT", ahead=Ahead(350.0, 1.5, 3),
    )  # fmt: skip
    asked = driving._replace(
        mode=float(Mode.TAKEOVER_REQUESTED), mode_label=say(settings.language, "TAKE OVER"), takeover_stage=1,
        remaining_s=7.0, todo_label=say(settings.language, "steer or brake"), handbrake=1.0, can_up=False,
        reason_label=say(settings.language, "driver asked"),
    )  # fmt: skip
    noticed = driving._replace(notice_label=say(settings.language, "off the road"), ahead=Ahead(12.0, is_end=True))
    return driving, asked, asked._replace(takeover_stage=2), noticed, driving._replace(stale=True)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize(("settings", "factor"), [(HudSettings(), 1.0), (GERMAN, 1.0), (GERMAN, LARGE_TEXT)])
def test_every_text_over_the_road_is_large_and_clear_enough(
    size: tuple[int, int], settings: HudSettings, factor: float
) -> None:
    """Rules 1 and 2 from pixels: contrast of at least 7 on the ground that most pixels have, and its height."""
    screen = screen_of_size(*size)._replace(text=factor)
    cabin, measured = cockpit(screen), 0
    for view in told(settings):
        picture = shown(cabin, screen, view)
        for item in layout(view, screen):
            if not isinstance(item, Text) or item.text in ("-", "--"):
                continue
            box = bounds(item)
            rows = slice(int(box.y) - 1, int(box.bottom) + 2)
            part = picture[rows, int(box.x) - 1 : int(box.right) + 2].astype(np.uint32)
            codes, counts = np.unique(part @ (65536, 256, 1), return_counts=True)
            ground = rgb(int(codes[counts.argmax()]))
            ink = max((rgb(int(code)) for code in codes), key=lambda colour: contrast(colour, ground))
            assert contrast(ink, ground) >= 7.0, (item, ground, ink)
            stands_out = (np.abs(part.astype(int) - ground).max(axis=2) > 40).any(axis=1)
            if item.text.isdigit() or (item.text.isascii() and item.text.isupper()):
                least_px = factor * item.arcmin * screen._replace(text=1.0).px_per_arcmin
                assert stands_out.sum() >= least_px - 1.0, item
            measured += 1
    assert measured > 60


def rgb(code: int) -> tuple[int, int, int]:
    return code >> 16, code >> 8 & 255, code & 255


@pytest.mark.parametrize("size", SIZES)
def test_large_text_leaves_half_of_the_screen_to_the_road(size: tuple[int, int]) -> None:
    instruments = panels_over_view(MANUAL, screen_of_size(*size)._replace(text=LARGE_TEXT))[-1]
    assert instruments.y > 0.5 * size[1]


@pytest.mark.parametrize("size", SIZES)
def test_the_road_has_most_of_the_screen(size: tuple[int, int]) -> None:
    instruments = panels_over_view(MANUAL, screen_of_size(*size))[-1]
    assert instruments.y > 0.6 * size[1]


def test_a_change_of_mode_is_in_the_next_frame() -> None:
    screen = screen_of_size(640, 480)
    picture = cockpit(screen)
    before = shown(picture, screen, MANUAL)
    assert (shown(picture, screen, MANUAL) == before).all()
    stopped = MANUAL._replace(mode=float(Mode.EMERGENCY_STOP), mode_label=mode_label(Mode.EMERGENCY_STOP))
    after = shown(picture, screen, stopped)
    fresh = shown(cockpit(screen), screen, stopped)
    assert (after == fresh).all()
    assert (after != before).any()


def test_a_message_hides_the_sky_only_while_there_is_one() -> None:
    screen = screen_of_size(640, 480)
    picture = cockpit(screen)
    free, said = shown(picture, screen, MANUAL), shown(picture, screen, MANUAL._replace(notice_label="lap 2"))
    assert len(panels_over_view(MANUAL, screen)) == 1
    box = panels_over_view(MANUAL._replace(notice_label="lap 2"), screen)[0]
    part = (slice(int(box.y) + 2, int(box.bottom) - 2), slice(int(box.x) + 2, int(box.right) - 2))
    assert (free[part] != said[part]).any(axis=2).mean() > 0.9
    assert (shown(picture, screen, MANUAL) == free).all()


@pytest.mark.parametrize("size", [*SIZES, (4200, 1050)])
@pytest.mark.parametrize("factor", [1.0, LARGE_TEXT])
def test_no_mirror_is_hidden_by_a_message_or_by_the_next_turn(size: tuple[int, int], factor: float) -> None:
    screen = screen_of_size(*size)._replace(text=factor)
    if screen.is_triple:
        screen = screen._replace(screen_width_m=4.8)
    said = MANUAL._replace(notice_label="lap 2", ahead=Ahead(350.0, 1.5, 3))
    *hiding, instruments = panels_over_view(said, screen)
    assert len(hiding) == 2
    parts = road_parts(fit(screen, *size), instruments.y)
    mirrors = looks(DriverViewProfile(), ShownVehicle(), SCENE.size, parts, *size)[1:]
    assert len(mirrors) == 3
    for look in mirrors:
        left, bottom, width, height = look.viewport.pixels(*size)
        top = size[1] - bottom - height
        assert width < 6 * height
        for box in (*hiding, instruments):
            apart = left >= box.right or left + width <= box.x or top >= box.bottom or top + height <= box.y
            assert apart, (look.viewport, box)


def test_the_road_goes_on_at_the_same_height_on_displays_beside() -> None:
    screen = screen_of_size(1400, 1050)
    displays = {0: Box(1280, 0, 1400, 1050), 1: Box(0, 0, 1280, 1024)}
    parts = road_parts(fit_span(screen, displays, 0), 800.0)
    own, beside = (parts.displays[number].pixels(2680, 1050) for number in (0, 1))
    assert own == parts.displays[None].pixels(2680, 1050) == (1280, 250, 1400, 800)
    assert beside == (0, 250, 1280, 800)


def test_stale_data_is_said_and_no_number_is_frozen() -> None:
    screen = screen_of_size(640, 480)
    picture = cockpit(screen)
    assert (shown(picture, screen, MANUAL) != shown(picture, screen, HudView(stale=True))).any()
    # The same words whatever was there before.
    assert (
        shown(picture, screen, MANUAL._replace(stale=True)) == shown(cockpit(screen), screen, HudView(stale=True))
    ).all()


def test_a_processor_that_draws_gets_the_cheap_picture_unless_told_otherwise() -> None:
    screen = screen_of_size(640, 480)
    cheap, rich = cockpit(screen), cockpit(screen, DriverViewProfile(always_rich=True))
    assert cheap.is_cheap == is_software(context())
    assert not rich.is_cheap
    assert (shown(cheap, screen, MANUAL) != shown(rich, screen, MANUAL)).any()
