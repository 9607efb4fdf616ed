"""Pictures of a recorded drive, drawn by OpenGL into memory."""

import sys
from collections.abc import Iterator
from typing import Literal, NamedTuple

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from simconsole.evaluation.video.moments import VideoFrame
from simconsole.hud.driver_view.scene import NO_MODELS, Models
from simconsole.hud.gl.cockpit_picture import CockpitPicture
from simconsole.hud.gl.context import renderer_name, windowless_context
from simconsole.hud.layout import check_screen
from simconsole.hud.screen import Screen, fit, text_factor
from simconsole.hud.window.display_memory import DisplayMemory
from simconsole.profiles.view import DriverViewProfile, HudProfile
from simconsole.session.view.external_view import display_settings
from simconsole.session.view.view_job import brought_models, view_job
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError

Pixels = NDArray[np.uint8]
CameraName = Literal["driver", "chase", "bird"]
RGB = 3


class Wanted(NamedTuple):
    """What the pictures are to be."""

    width_px: int
    height_px: int
    camera: CameraName = "driver"
    night: bool = False
    rich: bool = False  # mirrors, shadows and smooth edges, also where the processor draws
    large_text: bool = False


class DrivePictures:
    """Draws the moments of one drive, in their order: instruments remember what they showed."""

    def __init__(self, resolved: ResolvedSession, wanted: Wanted) -> None:
        """Make the scene of a session.

        Raises:
            ProfileError: the size is too small to be read, or of a shape that no screen has.
            WorkerError: this machine has no OpenGL 3.3 without a window.
        """
        hud = resolved.session.outputs.hud or HudProfile()
        profile = replace(
            hud.view or DriverViewProfile(), camera=wanted.camera, night=wanted.night, always_rich=wanted.rich
        )
        self._screen = Screen(
            wanted.width_px,
            wanted.height_px,
            hud.screen_width_m,
            hud.eye_distance_m,
            has_view=True,
            text=text_factor(large=wanted.large_text or hud.large_text),
        )
        settings = display_settings(resolved)
        check_screen(self._screen, "--size", settings)
        job = view_job(resolved, _models(resolved))
        context = windowless_context()
        self.renderer = renderer_name(context)
        fitted = fit(self._screen, wanted.width_px, wanted.height_px)._replace(display=hud.display)
        self._picture = CockpitPicture(context, job.scene(), profile, fitted, job.steering_ratio)
        self.is_cheap = self._picture.is_cheap
        self._target = context.simple_framebuffer((wanted.width_px, wanted.height_px), components=RGB)
        self._memory = DisplayMemory(settings)

    def pass_over(self, earlier: Iterator[VideoFrame]) -> None:
        """Let the instruments see moments that are not drawn: what they show depends on what was before."""
        for moment in earlier:
            self._memory.content(moment.snapshot, moment.t_s, None, None)

    def draw(self, moment: VideoFrame) -> Pixels:
        """Return one frame as red, green and blue, uint8 [height, width, 3] from the top."""
        content = self._memory.content(moment.snapshot, moment.t_s, None, None)
        self._picture.draw(self._target, moment.shown, content)
        width, height = self._target.size
        data = np.frombuffer(self._target.read(components=RGB, alignment=1), np.uint8)
        return np.ascontiguousarray(data.reshape(height, width, RGB)[::-1])

    def draw_all(self, frames: Iterator[VideoFrame]) -> Iterator[Pixels]:
        """Yield every frame."""
        return (self.draw(moment) for moment in frames)


def _models(resolved: ResolvedSession) -> Models:
    """Return the models that the drive was seen with; a bundle has not got them, and may have come from elsewhere."""
    try:
        return brought_models(resolved)
    except ProfileError as problem:
        print(f"driver's view: {problem}; drawn without", file=sys.stderr)
        return NO_MODELS
