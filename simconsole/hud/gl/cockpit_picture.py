"""One frame of the seat: the road above, the instruments below, for a window as for a file."""

from typing import TYPE_CHECKING, Final

from simconsole.hud.aids import NO_AIDS, Aids, aid_panels
from simconsole.hud.draw import Box, DrawItem
from simconsole.hud.driver_view.camera import Viewport
from simconsole.hud.driver_view.light import DAY, NIGHT
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import ViewScene
from simconsole.hud.driver_view.views import RoadParts, looks
from simconsole.hud.gl.context import is_software
from simconsole.hud.gl.overlay import Overlay
from simconsole.hud.gl.renderer import Quality, Renderer
from simconsole.hud.layout import layout, message_place, panels_over_view
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
        parts = road_parts(fitted, boxes[-1].y)
        pictures = looks(self._profile, shown, self._scene.size, parts, width, height)
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


def road_parts(fitted: Fitted, road_px: float) -> RoadParts:
    """Return which parts of a window show the road.

    Args:
        fitted: The screen, and how large the window is.
        road_px: Height of the road over the instruments.
    """
    screen, line_px = fitted.screen, fitted.top_px + road_px

    def part(box: Box) -> Viewport:
        """Return the part of a box above the instruments; all of it where it stands lower."""
        bottom = min(box.bottom, line_px) if line_px > box.y else box.bottom
        width, height = fitted.window_width_px, fitted.window_height_px
        return Viewport(box.x / width, 1.0 - bottom / height, box.w / width, (bottom - box.y) / height)

    own = part(Box(fitted.left_px, fitted.top_px, screen.width_px, screen.height_px))
    return RoadParts(
        displays={None: own, fitted.display: own, **{number: part(box) for number, box in fitted.others}},
        front=part(fitted.front()),
        below_messages=1.0 - message_place(screen).bottom / road_px,
    )


def _cheap(profile: DriverViewProfile) -> DriverViewProfile:
    """Return what a processor can draw at a useful rate."""
    from msgspec.structs import replace

    return replace(profile, mirrors=False, shadows=False, samples=0)
