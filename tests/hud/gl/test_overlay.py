import numpy as np
import pygame
import pytest

from simconsole.hud.draw import Box
from simconsole.hud.gl.overlay import Overlay
from tests.hud.gl.pictures import context, pixels, target

WIDTH_PX, HEIGHT_PX = 120, 80


@pytest.fixture
def surface() -> pygame.Surface:
    made = pygame.Surface((WIDTH_PX, HEIGHT_PX), 0, 32)
    made.fill((10, 200, 30))
    return made


def test_only_the_chosen_rectangles_hide_the_scene(surface: pygame.Surface) -> None:
    framebuffer = target(WIDTH_PX, HEIGHT_PX)
    framebuffer.clear(1.0, 0.0, 0.0)
    Overlay(context(), surface).draw(framebuffer, [Box(20.0, 10.0, 30.0, 15.0), Box(0.0, 70.0, 120.0, 10.0)])
    picture = pixels(framebuffer)
    hidden = (picture == (10, 200, 30)).all(axis=2)
    wanted = np.zeros((HEIGHT_PX, WIDTH_PX), dtype=bool)
    wanted[10:25, 20:50] = wanted[70:80, :] = True
    assert (hidden == wanted).all()
    assert (picture[~wanted] == (255, 0, 0)).all()


def test_colours_and_places_are_those_of_the_surface(surface: pygame.Surface) -> None:
    overlay, framebuffer = Overlay(context(), surface), target(WIDTH_PX, HEIGHT_PX)
    surface.fill((1, 2, 250), (33, 44, 5, 6))
    overlay.update([pygame.Rect(33, 44, 5, 6), pygame.Rect(110, 70, 50, 50)])  # the second one leaves the surface
    overlay.draw(framebuffer, [Box(0.0, 0.0, 120.0, 80.0)])
    picture = pixels(framebuffer)
    assert (picture[44:50, 33:38] == (1, 2, 250)).all()
    assert (picture[43, 33:38] == (10, 200, 30)).all()


def test_what_was_not_sent_is_not_shown(surface: pygame.Surface) -> None:
    overlay, framebuffer = Overlay(context(), surface), target(WIDTH_PX, HEIGHT_PX)
    surface.fill((0, 0, 0))
    overlay.update([])
    overlay.draw(framebuffer, [Box(0.0, 0.0, 120.0, 80.0)])
    assert (pixels(framebuffer) == (10, 200, 30)).all()
