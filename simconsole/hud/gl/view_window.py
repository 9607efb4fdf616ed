"""The road above the instruments in an OpenGL window."""

import os
import sys
from typing import TYPE_CHECKING

from msgspec.structs import replace

from simconsole.hud.aids import NO_AIDS, Aids
from simconsole.hud.driver_view.motion import ShownVehicle, moved, shown_vehicle
from simconsole.hud.driver_view.other_vehicles import at_moment
from simconsole.hud.driver_view.scene import ViewScene
from simconsole.hud.gl.cockpit_picture import CockpitPicture
from simconsole.hud.gl.context import context_of_window, renderer_name
from simconsole.hud.layout import check_screen
from simconsole.hud.screen import Fitted, fit, fit_span, screen_of
from simconsole.hud.view import HudSettings
from simconsole.hud.window.display_memory import DisplayMemory
from simconsole.hud.window.displays import Span, display_places, named_displays, span_of
from simconsole.hud.window.habits import Habits, habits_of
from simconsole.hud.window.ports import DriverWindow, Motion
from simconsole.hud.window.pygame_window import Window, dress_window, placed
from simconsole.hud.window.sdl_display import start_display
from simconsole.profiles.view import DriverViewProfile, HudProfile
from simconsole.values.errors import WorkerError
from simconsole.values.state_vector import Snapshot
from simconsole.world.rules.speed_advice import NO_ADVICE, Advice

if TYPE_CHECKING:
    import moderngl


class ViewWindow:
    """One window with the road and the instruments, no larger than the display."""

    def __init__(
        self,
        profile: HudProfile,
        view: DriverViewProfile,
        settings: HudSettings,
        scene: ViewScene,
        habits: Habits | None = None,
    ) -> None:
        """Open the window, as `habits` say or as the profile does.

        Raises:
            ProfileError: the screen is too small or too far away to be read.
            WorkerError: no OpenGL window can be opened here.
        """
        self._memory = DisplayMemory(settings)
        self._whole = screen_of(profile)
        check_screen(self._whole, "hud", settings)
        if sys.platform == "linux" and not any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY")):
            os.environ.setdefault("SDL_VIDEODRIVER", "offscreen")
        import pygame

        try:
            pygame.display.quit()  # one that this process opened before, for joysticks, may be of a kind without OpenGL
            start_display()
            self._habits = habits or habits_of(profile)
            self._span = _span(view, self._habits)
            self._context = _open(profile, self._habits, self._span)
        except WorkerError:
            pygame.display.quit()
            raise
        except Exception as problem:  # noqa: BLE001 SDL's and moderngl's own, and glcontext's bare Exception
            pygame.display.quit()
            raise WorkerError(f"driver's view: no OpenGL window can be opened: {problem}") from None
        self._target = self._context.screen
        fitted = self._fitted(*pygame.display.get_window_size())
        self._picture = CockpitPicture(self._context, scene, view, fitted, settings.hand_wheel_per_road_wheel)
        self.drawer = renderer_name(self._context)
        if self._picture.is_cheap:
            print(f"driver's view: {self.drawer} draws, no graphics card: no mirrors, no shadows", file=sys.stderr)
        self._shown = ShownVehicle()

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
        """Draw one frame: the vehicle between the two newest ticks, everything else of the newest one."""
        import pygame

        content = self._memory.content(snapshot, now_s, can_up, link, advice)
        if motion is not None:
            self._shown = moved(motion.older, motion.newer, motion.age_s)
            if motion.road_users is not None:
                now_s, tick_hz = self._shown.t_s, motion.newer.tick_hz
                others = at_moment(motion.road_users, now_s, tick_hz, motion.road_users_before)
                self._shown = self._shown._replace(others=others, signals=motion.road_users.signals)
        elif snapshot is not None:
            self._shown = shown_vehicle(snapshot)
        self._picture.draw(self._target, self._shown, content, aids)
        pygame.display.flip()

    def resized(self, width_px: int, height_px: int) -> None:
        """Draw as large as the window is now."""
        self._target.use()
        self._target.viewport = self._target.scissor = (0, 0, width_px, height_px)
        self._target = context_of_window().screen  # moderngl measures a window by its scissor, once for each context
        self._picture.resize(self._fitted(width_px, height_px))

    def _fitted(self, width_px: int, height_px: int) -> Fitted:
        if self._span is None:
            return fit(self._whole, width_px, height_px)._replace(display=self._habits.display)
        spanning = fit_span(self._whole, self._span.displays, self._habits.display)
        return spanning._replace(window_width_px=width_px, window_height_px=height_px)

    def close(self) -> None:
        """Close the window."""
        import pygame

        self._context.release()
        pygame.display.quit()


def _span(view: DriverViewProfile, habits: Habits) -> Span | None:
    """Return the window over all displays that the view names and the one with the instruments; None: it names none.

    Raises:
        WorkerError: one of them is not there.
    """
    named = named_displays(view) - {habits.display}
    return span_of(display_places({*named, habits.display})) if named else None


def _open(profile: HudProfile, habits: Habits, span: Span | None) -> "moderngl.Context":
    """Open an OpenGL window, in step with the display where that is wanted and can be had."""
    import pygame

    for name, value in (
        (pygame.GL_CONTEXT_MAJOR_VERSION, 3),
        (pygame.GL_CONTEXT_MINOR_VERSION, 3),
        (pygame.GL_CONTEXT_PROFILE_MASK, pygame.GL_CONTEXT_PROFILE_CORE),
        (pygame.GL_DEPTH_SIZE, 24),
    ):
        pygame.display.gl_set_attribute(name, value)
    if span is None:
        size, options = placed(profile, habits)
    else:
        size, options = (span.width_px, span.height_px), {"flags": pygame.NOFRAME, "display": habits.display}
    options["flags"] |= pygame.OPENGL | pygame.DOUBLEBUF
    try:
        pygame.display.set_mode(size, **options, vsync=int(habits.vsync))
    except pygame.error:
        if not habits.vsync:
            raise
        pygame.display.set_mode(size, **options)
    if span is not None:
        pygame.display.set_window_position((span.left_px, span.top_px))
    dress_window(fullscreen=habits.fullscreen or span is not None)
    return context_of_window()


def open_window(
    profile: HudProfile, settings: HudSettings, habits: Habits | None = None, *, scene: ViewScene | None
) -> DriverWindow:
    """Return the road above the instruments; the cluster alone where none is asked for or no OpenGL is to be had.

    Raises:
        ProfileError: the screen is too small or too far away to be read.
        WorkerError: no window can be opened here.
    """
    if profile.view is None or scene is None:
        return Window(profile, settings, habits)
    try:
        return ViewWindow(profile, profile.view, settings, scene, habits)
    except WorkerError as problem:
        print(f"{problem}; the instruments are shown without the road", file=sys.stderr)
        return Window(replace(profile, view=None), settings, habits)
