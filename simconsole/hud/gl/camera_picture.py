"""What a camera on the vehicle sees, as JPEG: the scene without instruments, for programs of others."""

import io
import math
from typing import TYPE_CHECKING, Final

from simconsole.hud.driver_view.camera import Viewport
from simconsole.hud.driver_view.light import DAY, NIGHT
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import ViewScene
from simconsole.hud.driver_view.views import mounted
from simconsole.hud.gl.context import is_software
from simconsole.hud.gl.renderer import Quality, Renderer
from simconsole.profiles.bridge import CameraProfile

if TYPE_CHECKING:
    import moderngl

RGB: Final = 3
SAMPLES: Final = 4


class CameraPicture:
    """Draws pictures of one camera on one context."""

    def __init__(self, context: "moderngl.Context", scene: ViewScene, profile: CameraProfile) -> None:
        """Put the scene on the card; a processor that draws smooths no edges and throws no shadows."""
        self._context, self._profile = context, profile
        is_cheap = is_software(context)
        quality = Quality(shadows=not is_cheap, detail=not is_cheap)
        self._renderer = Renderer(context, scene, NIGHT if profile.night else DAY, quality, 1.0)
        size = (profile.width_px, profile.height_px)
        self._target = context.simple_framebuffer(size, components=RGB)
        samples = 0 if is_cheap else min(SAMPLES, context.max_samples)
        self._smooth = context.simple_framebuffer(size, components=RGB, samples=samples) if samples else None

    def jpeg(self, shown: ShownVehicle) -> bytes:
        """Return the picture at one moment."""
        import pygame

        look = mounted(
            shown,
            (self._profile.x_m, self._profile.y_m, self._profile.z_m),
            (math.radians(self._profile.yaw_deg), math.radians(self._profile.pitch_deg)),
            math.radians(self._profile.horizontal_fov_deg),
            self._profile.width_px / self._profile.height_px,
        )._replace(viewport=Viewport())
        self._renderer.draw(self._smooth or self._target, [look], shown)
        if self._smooth is not None:
            self._context.copy_framebuffer(self._target, self._smooth)
        pixels = self._target.read(components=RGB, alignment=1)
        surface = pygame.transform.flip(pygame.image.frombuffer(pixels, self._target.size, "RGB"), False, True)
        file = io.BytesIO()
        pygame.image.save(surface, file, "camera.jpg")
        return file.getvalue()
