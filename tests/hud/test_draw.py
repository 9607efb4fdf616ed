import pygame
import pytest

from simconsole.hud.draw import (
    TEXT,
    Arc,
    Box,
    Polygon,
    Rect,
    Text,
    around,
    bounds,
    contrast,
    fit_cap_px,
    luminance,
    text_width_px,
)


def test_boxes_measure_themselves() -> None:
    box = Box(10.0, 20.0, 30.0, 40.0)
    assert (box.right, box.bottom, box.cx, box.cy) == (40.0, 60.0, 25.0, 40.0)
    assert box.row(0.5, 1.0) == Box(10.0, 40.0, 30.0, 20.0)
    assert box.column(0.0, 0.5) == Box(10.0, 20.0, 15.0, 40.0)
    assert box.inset(5.0) == Box(15.0, 25.0, 20.0, 30.0)
    assert bounds(Rect(box, TEXT, "x")) == box


def test_the_width_table_is_that_of_the_font() -> None:
    pygame.font.init()
    font = pygame.font.Font(None, 1000)
    for code in range(32, 127):
        assert abs(text_width_px(chr(code), 501.0) - font.size(chr(code))[0]) < 1.0, chr(code)


def test_fitting_keeps_words_inside() -> None:
    assert fit_cap_px("MANUAL", 30.0, 1000.0) == 30.0
    cap = fit_cap_px("MANUAL", 30.0, 50.0)
    assert text_width_px("MANUAL", cap) == pytest.approx(50.0)


def test_corners_run_clockwise_from_twelve() -> None:
    wanted = [(10.0, 5.0), (15.0, 10.0), (10.0, 15.0), (5.0, 10.0)]
    for corner, at in zip(around(10.0, 10.0, 5.0, 4), wanted, strict=True):
        assert corner == pytest.approx(at)
    assert around(0.0, 0.0, 2.0, 3, 180.0)[0] == pytest.approx((0.0, 2.0))


@pytest.mark.parametrize(("anchor", "left"), [("l", 100.0), ("c", 0.5), ("r", 1.0)])
def test_words_lie_where_their_anchor_says(anchor: str, left: float) -> None:
    width = text_width_px("42", 30.0)
    box = bounds(Text(100.0, 50.0, "42", 30.0, TEXT, "x", anchor))
    assert box == pytest.approx((100.0 if anchor == "l" else 100.0 - left * width, 35.0, width, 30.0))


def test_a_shape_stays_inside_its_bounds() -> None:
    assert bounds(Polygon(((1.0, 8.0), (4.0, 2.0), (7.0, 5.0)), TEXT, "x")) == Box(1.0, 2.0, 6.0, 6.0)
    assert bounds(Arc(50.0, 40.0, 10.0, 4.0, 0.0, 90.0, TEXT, "x")) == Box(40.0, 30.0, 20.0, 20.0)


def test_contrast_is_that_of_wcag() -> None:
    black, white = (0, 0, 0), (255, 255, 255)
    assert contrast(black, white) == contrast(white, black) == pytest.approx(21.0)
    assert contrast(white, (118, 118, 118)) == pytest.approx(
        4.54, abs=0.005
    )  # the lightest grey that passes AA on white
    assert contrast(white, (119, 119, 119)) < 4.5
    assert luminance((10, 10, 10)) == pytest.approx(luminance((11, 11, 11)), rel=0.12), "both branches meet"
