import pygame
import pytest

from simconsole.hud.draw import (
    TEXT,
    Box,
    Rect,
    bounds,
    fit_cap_px,
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
