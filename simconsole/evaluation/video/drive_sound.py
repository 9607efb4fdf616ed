"""What is heard of a recorded drive, moment after moment."""

import numpy as np

from simconsole.evaluation.video.moments import VideoFrame
from simconsole.hud.sound.directions import Samples, to_stereo
from simconsole.hud.sound.heard import Listener
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.hud.sound.mix import Mixer
from simconsole.hud.sound.passing import audible
from simconsole.profiles.view import SoundProfile
from simconsole.session.sound_worker import EAR_SHARE, sound_settings
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.values.host.jit import plain


class DriveSound:
    """The sound of one drive's video frames, in their order."""

    def __init__(self, resolved: ResolvedSession, fps: int) -> None:
        """Take a session; its platform's own columns are not in a recorded moment, so wheels that lock are silent."""
        settings = sound_settings(resolved, assemble(resolved, plain)[0])._replace(wheels=None)
        self._mixer = Mixer(settings.cylinders, resolved.session.outputs.sound or SoundProfile())
        self._listener = Listener(settings)
        self._ear_x_m = EAR_SHARE * settings.wheelbase_m
        self._fps = fps
        self._frames = 0

    def frame(self, moment: VideoFrame) -> Samples:
        """Return the samples of one frame, float32 [samples, 2] within -1 and 1."""
        before, self._frames = self._frames, self._frames + 1
        count = self._frames * RATE_HZ // self._fps - before * RATE_HZ // self._fps
        others = audible(moment.snapshot, moment.shown.others, self._ear_x_m)
        block = self._mixer.block(self._listener(moment.snapshot, others), count)
        return np.clip(to_stereo(block), -1.0, 1.0)
