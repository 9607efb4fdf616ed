"""The page before a drive in a window of its own."""

from typing import Final

from simconsole.hud.screen import fit, screen_of
from simconsole.hud.start_page import Act, StartPage, moved, start_page
from simconsole.hud.window.habits import habits_of
from simconsole.hud.window.pygame_window import dress_window, placed
from simconsole.hud.window.raster import Painter
from simconsole.hud.window.sdl_display import start_display
from simconsole.profiles.view import HudProfile
from simconsole.values.errors import WorkerError

RATE_HZ: Final = 30
_ACTS: Final = {"K_UP": Act.UP, "K_DOWN": Act.DOWN, "K_LEFT": Act.LEFT, "K_RIGHT": Act.RIGHT, "K_TAB": Act.RIGHT}


def choose(page: StartPage, profile: HudProfile) -> StartPage | None:
    """Show the page until a person has chosen; return it as they left it, None if they want nothing of it.

    Raises:
        WorkerError: no window can be opened here.
    """
    painter = Painter()
    import pygame

    try:
        start_display()
        size, options = placed(profile, habits_of(profile))
        pygame.display.set_mode(size, **options)
    except pygame.error as problem:
        raise WorkerError(f"start page: no window can be opened: {problem}") from None
    dress_window(fullscreen=False)
    clock, acts = pygame.time.Clock(), {getattr(pygame, name): act for name, act in _ACTS.items()}
    try:
        while True:
            for event in pygame.event.get():
                if event.type == pygame.QUIT or (event.type == pygame.KEYDOWN and event.key == pygame.K_ESCAPE):
                    return None
                if event.type == pygame.KEYDOWN and event.key in (pygame.K_RETURN, pygame.K_KP_ENTER):
                    return page
                if event.type == pygame.KEYDOWN and event.key in acts:
                    page = moved(page, acts[event.key])
            whole = pygame.display.get_surface()
            assert whole is not None
            fitted = fit(screen_of(profile), *whole.get_size())
            place = (fitted.left_px, fitted.top_px, fitted.screen.width_px, fitted.screen.height_px)
            painter.paint(whole.subsurface(place), start_page(page, fitted.screen))
            pygame.display.flip()
            clock.tick(RATE_HZ)
    finally:
        pygame.display.quit()
