"""The road above the instruments in an OpenGL window."""

import os
import sys

from msgspec.structs import replace

from simconsole.hud.driver_view.motion import ShownVehicle, moved, shown_vehicle
from simconsole.hud.driver_view.other_vehicles import at_moment
from simconsole.hud.driver_view.scene import ViewScene
from simconsole.hud.gl.cockpit_picture import CockpitPicture
from simconsole.hud.gl.context import context_of_window, renderer_name
from simconsole.hud.layout import check_screen
from simconsole.hud.screen import Screen, screen_of
from simconsole.hud.view import HudSettings
from simconsole.hud.window.display_memory import DisplayMemory
from simconsole.hud.window.pygame_window import DriverWindow, Motion, Window
from simconsole.profiles.view import DriverViewProfile, HudProfile
from simconsole.values.errors import ProfileError, WorkerError
from simconsole.values.state_vector import Snapshot


class ViewWindow:
    """One window with the road and the instruments, no larger than the display."""

    def __init__(self, profile: HudProfile, view: DriverViewProfile, settings: HudSettings, scene: ViewScene) -> None:
        """Open the window.

        Raises:
            ProfileError: the screen is too small or too far away to be read.
            WorkerError: no OpenGL window can be opened here.
        """
        self._memory = DisplayMemory(settings)
        if sys.platform == "linux" and not any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")):
            os.environ.setdefault("SDL_VIDEODRIVER", "offscreen")
        import pygame

        try:
            pygame.display.quit()  # one that this process opened before, for joysticks, may be of a kind without OpenGL
            pygame.display.init()
            self._screen = _fitting(screen_of(profile), pygame.display.get_desktop_sizes())
            check_screen(self._screen, "hud")
            for name, value in (
                (pygame.GL_CONTEXT_MAJOR_VERSION, 3),
                (pygame.GL_CONTEXT_MINOR_VERSION, 3),
                (pygame.GL_CONTEXT_PROFILE_MASK, pygame.GL_CONTEXT_PROFILE_CORE),
                (pygame.GL_DEPTH_SIZE, 24),
            ):
                pygame.display.gl_set_attribute(name, value)
            flags = pygame.OPENGL | pygame.DOUBLEBUF | (pygame.FULLSCREEN if profile.fullscreen else 0)
            pygame.display.set_mode((self._screen.width_px, self._screen.height_px), flags)
            context = context_of_window()
        except ProfileError:
            pygame.display.quit()
            raise
        except Exception as problem:  # noqa: BLE001 SDL's and moderngl's own, and glcontext's bare Exception
            pygame.display.quit()
            raise WorkerError(f"driver's view: no OpenGL window can be opened: {problem}") from None
        pygame.display.set_caption("simconsole")
        pygame.mouse.set_visible(not profile.fullscreen)
        self._context = context
        self._picture = CockpitPicture(context, scene, view, self._screen, settings.hand_wheel_per_road_wheel)
        if self._picture.is_cheap:
            drawer = renderer_name(context)
            print(f"driver's view: {drawer} draws, no graphics card: no mirrors, no shadows", file=sys.stderr)
        self._shown = ShownVehicle()

    def frame(
        self,
        snapshot: Snapshot | None,
        now_s: float,
        can_up: bool | None = None,
        link: str | None = None,
        motion: Motion | None = None,
    ) -> None:
        """Draw one frame: the vehicle between the two newest ticks, everything else of the newest one."""
        import pygame

        content = self._memory.content(snapshot, now_s, can_up, link)
        if motion is not None:
            self._shown = moved(motion.older, motion.newer, motion.age_s)
            if motion.road_users is not None:
                others = at_moment(motion.road_users, self._shown.t_s, motion.newer.tick_hz)
                self._shown = self._shown._replace(others=others)
        elif snapshot is not None:
            self._shown = shown_vehicle(snapshot)
        self._picture.draw(self._context.screen, self._shown, content)
        pygame.display.flip()

    def close(self) -> None:
        """Close the window."""
        import pygame

        self._context.release()
        pygame.display.quit()


def _fitting(screen: Screen, displays: list[tuple[int, int]]) -> Screen:
    """Return the largest screen of the same shape that fits the first display."""
    width, height = displays[0] if displays else (screen.width_px, screen.height_px)
    share = min(1.0, width / screen.width_px, height / screen.height_px)
    return screen._replace(width_px=int(screen.width_px * share), height_px=int(screen.height_px * share))


def open_window(profile: HudProfile, settings: HudSettings, scene: ViewScene | None) -> DriverWindow:
    """Return the road above the instruments; the cluster alone where none is asked for or no OpenGL is to be had.

    Raises:
        ProfileError: the screen is too small or too far away to be read.
        WorkerError: no window can be opened here.
    """
    if profile.view is None or scene is None:
        return Window(profile, settings)
    try:
        return ViewWindow(profile, profile.view, settings, scene)
    except WorkerError as problem:
        print(f"{problem}; the instruments are shown without the road", file=sys.stderr)
        return Window(replace(profile, view=None), settings)
