import math

import pytest

from simconsole.hud.draw import Polygon, bounds
from simconsole.hud.guidance import Ahead
from simconsole.hud.layout import layout, panels_over_view, places_under_view
from simconsole.hud.screen import Screen
from simconsole.hud.turn_sign import distance_label
from simconsole.hud.view import HudView
from tests.hud.pictures import GERMAN, SCREEN, by_role, texts

OVER_ROAD = SCREEN._replace(has_view=True)


@pytest.mark.parametrize(
    ("distance_m", "english", "german"),
    [
        (0.0, "now", "jetzt"), (4.9, "now", "jetzt"), (5.1, "10 m", "10 m"), (96.0, "100 m", "100 m"),
        (130.0, "150 m", "150 m"), (960.0, "950 m", "950 m"),
        (980.0, "1.0 km", "1,0 km"), (12345.0, "12.3 km", "12,3 km"),
    ],
)  # fmt: skip
def test_distances_are_as_coarse_as_they_are_used(distance_m: float, english: str, german: str) -> None:
    assert distance_label(HudView(), distance_m) == english
    assert distance_label(HudView(settings=GERMAN), distance_m) == german


def tip(angle_rad: float, number: int = 0) -> tuple[float, float]:
    """Where the arrow points, from the middle of its bar: right and up positive."""
    items = layout(HudView(ahead=Ahead(100.0, angle_rad, number)), OVER_ROAD)
    bar, head = [item for item in by_role(items, "turn.arrow") if isinstance(item, Polygon)][-2:]
    box = bounds(bar)
    return head.points[0][0] - box.cx, box.cy - head.points[0][1]


@pytest.mark.parametrize("number", [0, 2])
def test_the_arrow_points_where_the_route_goes(number: int) -> None:
    for angle_deg in (-120, -90, -45, 0, 45, 90, 120):
        right, up = tip(math.radians(angle_deg), number)
        assert math.degrees(math.atan2(-right, up)) == pytest.approx(angle_deg, abs=1.0)


def test_a_roundabout_has_a_ring_with_the_exits_number() -> None:
    items = layout(HudView(ahead=Ahead(100.0, 1.5, 3)), OVER_ROAD)
    assert [item.text for item in texts(items) if item.role == "turn.exit"] == ["3"]
    assert by_role(items, "turn.ring")
    assert not by_role(layout(HudView(ahead=Ahead(100.0, 1.5)), OVER_ROAD), "turn.ring")


@pytest.mark.parametrize("screen", [SCREEN, OVER_ROAD], ids=["cluster", "view"])
def test_no_arrow_is_shown_without_a_route_or_with_old_data(screen: Screen) -> None:
    def shown(view: HudView) -> bool:
        return any(item.role.startswith("turn.") for item in layout(view, screen))

    told = HudView(ahead=Ahead(100.0, 1.5))
    assert shown(told)
    assert not shown(told._replace(stale=True))
    assert not shown(HudView())
    assert shown(told._replace(ahead=Ahead(10.0, is_end=True)))


def test_the_sign_hides_the_road_only_where_it_stands() -> None:
    place = places_under_view(OVER_ROAD).turn
    assert place in panels_over_view(HudView(ahead=Ahead(100.0, 1.5)), OVER_ROAD)
    assert len(panels_over_view(HudView(), OVER_ROAD)) == 1
    message = panels_over_view(HudView(ahead=Ahead(100.0, 1.5), refusal_label="no"), OVER_ROAD)[0]
    assert place.y > message.bottom
