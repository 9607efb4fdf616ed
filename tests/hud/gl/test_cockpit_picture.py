import numpy as np
import pytest

from simconsole.hud.draw import contrast
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import view_scene
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.gl.cockpit_picture import CockpitPicture
from simconsole.hud.gl.context import is_software
from simconsole.hud.layout import panels_over_view
from simconsole.hud.screen import Screen, fit
from simconsole.hud.view import HudView
from simconsole.profiles.view import DriverViewProfile
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from tests.hud.gl.pictures import Pixels, context, pixels, target

SIZES = ((640, 480), (1366, 768), (1400, 1050), (1920, 1080))
SCENE = view_scene(None, 0.0, Size(3.99, 1.75, 1.45, 0.75, 2.5))
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
