"""The cluster in a window that the processor draws."""

import os
from typing import TYPE_CHECKING

from simconsole.hud.aids import NO_AIDS, Aids, aid_panels
from simconsole.hud.draw import DrawItem
from simconsole.hud.layout import check_screen, layout, sample_views
from simconsole.hud.screen import fit, screen_of, window_size
from simconsole.hud.view import HudSettings
from simconsole.hud.window.display_memory import DisplayMemory
from simconsole.hud.window.habits import Habits, habits_of
from simconsole.hud.window.ports import Motion
from simconsole.hud.window.raster import Painter
from simconsole.hud.window.sdl_display import choose_display, start_display
from simconsole.profiles.view import HudProfile
from simconsole.values.errors import WorkerError
from simconsole.values.state_vector import Snapshot
from simconsole.world.rules.speed_advice import NO_ADVICE, Advice

if TYPE_CHECKING:
    pass


class Window:
    """One window with one cluster."""

    drawer = "processor, no OpenGL"

    def __init__(self, profile: HudProfile, settings: HudSettings, habits: Habits | None = None) -> None:
        """Open the window, as `habits` say or as the profile does.

        Raises:
            ProfileError: the screen is too small or too far away to be read.
            WorkerError: no window can be opened here.
        """
        self._whole = screen_of(profile)
        check_screen(self._whole, "hud", settings)
        self._memory = DisplayMemory(settings)
        self._painter = Painter()
        self._drawn: list[DrawItem] = []
        choose_display()
        import pygame

        try:
            start_display()
            if pygame.display.get_driver() == "x11":
                # SDL would send each frame through OpenGL: 130 against 600 frames a second where a processor draws.
                os.environ.setdefault("SDL_FRAMEBUFFER_ACCELERATION", "0")
            size, options = placed(profile, habits or habits_of(profile))
            pygame.display.set_mode(size, **options)
        except pygame.error as problem:
            raise WorkerError(f"hud: no window can be opened: {problem}") from None
        dress_window(fullscreen=bool(options["flags"] & pygame.FULLSCREEN))
        # Never shown. They load the fonts, which takes longer than a keyboard may be silent before it counts as lost.
        self._take_size()
        before: list[DrawItem] = []
        for sample in sample_views(settings):
            after = layout(sample, self._screen)
            self._painter.repaint(self._surface, before, after)
            before = after

    def frame(
        self,
        snapshot: Snapshot | None,
        now_s: float,
        can_up: bool | None = None,
        link: str | None = None,
        motion: Motion | None = None,
        aids: Aids = NO_AIDS,
        advice: Advice = NO_ADVICE,
    ) -> None:
        """Draw one frame; one equal to the last costs nothing."""
        import pygame

        items = layout(self._memory.content(snapshot, now_s, can_up, link, advice), self._screen)
        for panel in aid_panels(aids, self._screen):
            items += panel.items
        if items == self._drawn:
            return
        areas = self._painter.repaint(self._surface, self._drawn, items)
        left, top = self._surface.get_offset()
        pygame.display.update([area.move(left, top) for area in areas])
        self._drawn = items

    def resized(self, width_px: int, height_px: int) -> None:
        """Draw as large as the window is now."""
        self._take_size()

    def close(self) -> None:
        """Close the window."""
        import pygame

        pygame.display.quit()

    def _take_size(self) -> None:
        import pygame

        whole = pygame.display.get_surface()
        assert whole is not None
        fitted = fit(self._whole, *whole.get_size())
        self._screen, self._drawn = fitted.screen, []
        whole.fill((0, 0, 0))
        pygame.display.flip()
        place = (fitted.left_px, fitted.top_px, fitted.screen.width_px, fitted.screen.height_px)
        self._surface: pygame.Surface = whole.subsurface(place)


def open_cluster(profile: HudProfile, settings: HudSettings, habits: Habits) -> Window:
    """Open the cluster alone.

    Raises:
        ProfileError: the screen is too small or too far away to be read.
        WorkerError: no window can be opened here.
    """
    return Window(profile, settings, habits)


def placed(profile: HudProfile, habits: Habits) -> "tuple[tuple[int, int], dict[str, int]]":
    """Return the size of a window and how to open it: never larger than its display, and on one that there is."""
    import pygame

    displays = pygame.display.get_desktop_sizes()
    display = habits.display if habits.display < len(displays) else 0
    width, height = displays[display] if displays else (profile.width_px, profile.height_px)
    if habits.fullscreen:
        return (width, height), {"flags": pygame.FULLSCREEN, "display": display}
    size = habits.size_px or window_size(screen_of(profile), (width, height))
    return (min(size[0], width), min(size[1], height)), {"flags": pygame.RESIZABLE, "display": display}


def dress_window(*, fullscreen: bool) -> None:
    """Name the open window, and hide the pointer where it only disturbs."""
    import pygame

    pygame.display.set_caption("simconsole")
    pygame.mouse.set_visible(not fullscreen)
