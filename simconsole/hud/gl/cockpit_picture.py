"""One frame of the seat: the road above, the instruments below, for a window as for a file."""

from typing import TYPE_CHECKING, Final

from simconsole.hud.draw import DrawItem
from simconsole.hud.driver_view.camera import Viewport
from simconsole.hud.driver_view.light import DAY, NIGHT
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import ViewScene
from simconsole.hud.driver_view.views import looks
from simconsole.hud.gl.context import is_software
from simconsole.hud.gl.overlay import Overlay
from simconsole.hud.gl.renderer import Quality, Renderer
from simconsole.hud.layout import layout, panels_over_view
from simconsole.hud.screen import Screen
from simconsole.hud.view import HudView
from simconsole.hud.window.raster import Painter
from simconsole.profiles.view import DriverViewProfile

if TYPE_CHECKING:
    import moderngl

COLOURS: Final = 4


class CockpitPicture:
    """Draws frames of one size on one context."""

    def __init__(
        self,
        context: "moderngl.Context",
        scene: ViewScene,
        profile: DriverViewProfile,
        screen: Screen,
        steering_ratio: float,
    ) -> None:
        """Make everything that all frames share; a processor that draws gets the cheap picture.

        Args:
            context: OpenGL 3.3 or later.
            scene: What stands around the vehicle.
            profile: Cameras, light and quality.
            screen: Size of the picture.
            steering_ratio: Hand-wheel angle per road-wheel angle.
        """
        self._painter = Painter()  # before pygame is imported anywhere: it keeps its greeting off standard output
        import pygame

        self._context, self._scene, self._screen = context, scene, screen
        self.is_cheap = is_software(context) and not profile.always_rich
        self._profile = _cheap(profile) if self.is_cheap else profile
        quality = Quality(shadows=self._profile.shadows, detail=not self.is_cheap)
        self._renderer = Renderer(context, scene, NIGHT if profile.night else DAY, quality, steering_ratio)
        self._surface = pygame.Surface((screen.width_px, screen.height_px), 0, 32)
        self._overlay = Overlay(context, self._surface)
        self._drawn: list[DrawItem] = []
        size, samples = (screen.width_px, screen.height_px), min(self._profile.samples, context.max_samples)
        self._smooth = None
        if samples > 1:
            colour = context.renderbuffer(size, COLOURS, samples=samples)
            self._smooth = context.framebuffer([colour], context.depth_renderbuffer(size, samples=samples))

    def draw(self, target: "moderngl.Framebuffer", shown: ShownVehicle, view: HudView) -> None:
        """Draw one frame into a framebuffer of the picture's size."""
        screen = self._screen
        boxes = panels_over_view(view, screen)
        window = Viewport(0.0, 1.0 - boxes[-1].y / screen.height_px, 1.0, boxes[-1].y / screen.height_px)
        pictures = looks(self._profile, shown, self._scene.size, window, screen.width_px, screen.height_px)
        scene_target = target if self._smooth is None else self._smooth
        self._renderer.draw(scene_target, pictures, shown)
        if self._smooth is not None:
            self._context.copy_framebuffer(target, self._smooth)
        items = layout(view, screen)
        if items != self._drawn:
            self._overlay.update(self._painter.repaint(self._surface, self._drawn, items))
            self._drawn = items
        self._overlay.draw(target, boxes)


def _cheap(profile: DriverViewProfile) -> DriverViewProfile:
    """Return what a processor can draw at a useful rate."""
    from msgspec.structs import replace

    return replace(profile, mirrors=False, shadows=False, samples=0)
