"""One frame of the seat: the road above, the instruments below, for a window as for a file."""

from typing import TYPE_CHECKING, Final

from simconsole.hud.aids import NO_AIDS, Aids, aid_panels
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
from simconsole.hud.screen import Fitted
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
        fitted: Fitted,
        steering_ratio: float,
    ) -> None:
        """Make everything that all frames share; a processor that draws gets the cheap picture.

        Args:
            context: OpenGL 3.3 or later.
            scene: What stands around the vehicle.
            profile: Cameras, light and quality.
            fitted: The screen, and how large the window is.
            steering_ratio: Hand-wheel angle per road-wheel angle.
        """
        self._painter = Painter()  # before pygame is imported anywhere: it keeps its greeting off standard output
        self._context, self._scene = context, scene
        self.is_cheap = is_software(context) and not profile.always_rich
        self._profile = _cheap(profile) if self.is_cheap else profile
        quality = Quality(shadows=self._profile.shadows, detail=not self.is_cheap)
        self._renderer = Renderer(context, scene, NIGHT if profile.night else DAY, quality, steering_ratio)
        self._samples = min(self._profile.samples, context.max_samples)
        self._overlay: Overlay | None = None
        self._smooth: moderngl.Framebuffer | None = None
        self.resize(fitted)

    def resize(self, fitted: Fitted) -> None:
        """Draw frames of another size from now on."""
        import pygame

        if self._overlay is not None:
            self._overlay.release()
        if self._smooth is not None:
            self._smooth.release()
            self._smooth = None
        self._fitted, self._drawn = fitted, list[DrawItem]()
        screen, size = fitted.screen, (fitted.window_width_px, fitted.window_height_px)
        whole = pygame.Surface(size, 0, 32)
        self._surface = whole.subsurface(fitted.left_px, fitted.top_px, screen.width_px, screen.height_px)
        self._overlay = Overlay(self._context, whole)
        if self._samples > 1:
            colour = self._context.renderbuffer(size, COLOURS, samples=self._samples)
            depth = self._context.depth_renderbuffer(size, samples=self._samples)
            self._smooth = self._context.framebuffer([colour], depth)

    def draw(self, target: "moderngl.Framebuffer", shown: ShownVehicle, view: HudView, aids: Aids = NO_AIDS) -> None:
        """Draw one frame into a framebuffer of the window's size."""
        assert self._overlay is not None
        fitted, screen = self._fitted, self._fitted.screen
        width, height, left, top = fitted.window_width_px, fitted.window_height_px, fitted.left_px, fitted.top_px
        boxes = panels_over_view(view, screen)
        road_px = boxes[-1].y  # down to where the instruments begin
        window = Viewport(left / width, 1.0 - (top + road_px) / height, screen.width_px / width, road_px / height)
        pictures = looks(self._profile, shown, self._scene.size, window, width, height)
        scene_target = target if self._smooth is None else self._smooth
        if fitted.has_bars:
            scene_target.clear()
        self._renderer.draw(scene_target, pictures, shown)
        if self._smooth is not None:
            self._context.copy_framebuffer(target, self._smooth)
        panels = aid_panels(aids, screen)
        items = [*layout(view, screen), *(item for panel in panels for item in panel.items)]
        if items != self._drawn:
            areas = self._painter.repaint(self._surface, self._drawn, items)
            self._overlay.update([area.move(left, top) for area in areas])
            self._drawn = items
        hiding = (*boxes, *(panel.box for panel in panels))
        self._overlay.draw(target, [box._replace(x=box.x + left, y=box.y + top) for box in hiding])


def _cheap(profile: DriverViewProfile) -> DriverViewProfile:
    """Return what a processor can draw at a useful rate."""
    from msgspec.structs import replace

    return replace(profile, mirrors=False, shadows=False, samples=0)
