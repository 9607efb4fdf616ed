import pytest

from simconsole.hud.draw import Text, bounds
from simconsole.hud.layout import check_screen, layout, panels_over_view, sample_views
from simconsole.hud.screen import Screen
from simconsole.hud.view import HudView
from simconsole.values.errors import ProfileError
from tests.hud.pictures import by_role, texts

SCREEN = Screen(1400, 1050, 1.6, 2.2, has_view=True)
WELL = HudView(
    shown_kmh=52, rpm=2310.0, engine_running=True, gear="4", wheel_validity=2.0, pedals_validity=2.0,
    shifter_validity=2.0, handbrake_validity=2.0, t_s=75.0, distance_m=1250.0,
)  # fmt: skip


def words(view: HudView) -> set[str]:
    return {item.text for item in texts(layout(view, SCREEN))}


@pytest.mark.parametrize(
    "size", [(1400, 1050, 1.6), (640, 480, 1.6), (1366, 768, 1.6), (1920, 1080, 1.6), (5760, 1080, 4.8)]
)
def test_every_text_can_be_read_on_every_shape_of_screen(size: tuple[int, int, float]) -> None:
    width, height, wide_m = size
    check_screen(Screen(width, height, wide_m, 2.2, has_view=True), "hud")


def test_a_screen_too_small_to_be_read_is_refused() -> None:
    with pytest.raises(ProfileError, match="arc minutes high"):
        check_screen(Screen(1400, 500, 1.6, 4.0, has_view=True), "hud")


def test_all_that_is_shown_stands_on_a_panel_that_hides_the_road() -> None:
    for view in sample_views():
        boxes = panels_over_view(view, SCREEN)
        for item in layout(view, SCREEN):
            if item.role != "ground":
                area = bounds(item)
                assert any(
                    box.x <= area.x and box.y <= area.y and area.right <= box.right and area.bottom <= box.bottom
                    for box in boxes
                ), item


def test_speed_gear_and_engine_speed_are_told() -> None:
    assert {"52", "km/h", "4", "2300 rpm"} <= words(WELL)
    slot, bar = (bounds(by_role(layout(WELL, SCREEN), f"rpm.{part}")[0]) for part in ("slot", "bar"))
    assert bar.w == pytest.approx(2310.0 / 7000.0 * slot.w)


def test_the_speed_limit_is_shown_as_its_sign_where_there_is_one() -> None:
    assert not by_role(layout(WELL, SCREEN), "limit.ring")
    items = layout(WELL._replace(limit_kmh=50), SCREEN)
    (ring,), (text,) = by_role(items, "limit.ring"), by_role(items, "limit")
    assert isinstance(text, Text)
    assert text.text == "50"
    outer, inner = bounds(ring), bounds(text)
    assert outer.x < inner.x
    assert inner.right < outer.right
    assert not by_role(layout(WELL._replace(limit_kmh=50, stale=True), SCREEN), "limit")


def test_lamps_tell_what_is_wrong_and_nothing_else() -> None:
    well, lost = words(WELL), words(WELL._replace(wheel_validity=4.0))
    assert {"01:15", "1.2 km"} <= well
    assert "WHEEL" not in well
    assert {"WHEEL", "lost"} <= lost
    assert "01:15" not in lost


def test_stale_data_leaves_no_number() -> None:
    stale = words(WELL._replace(stale=True))
    assert "NO DATA" in stale
    assert not any(character.isdigit() for text in stale for character in text)


def test_the_shift_arrow_comes_only_over_red_with_a_gear_left() -> None:
    red = WELL._replace(rpm=6500.0)
    assert by_role(layout(red, SCREEN), "shift")
    assert not by_role(layout(red._replace(gear="6"), SCREEN), "shift")
    assert not by_role(layout(WELL, SCREEN), "shift")
