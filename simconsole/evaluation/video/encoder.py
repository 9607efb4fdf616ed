"""Pictures into files: H.264 in MP4, and PNG."""

import io
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from simconsole.hud.sound.directions import Samples
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import replaced, write_atomically

Pixels = NDArray[np.uint8]


class Frame(NamedTuple):
    """A picture, uint8 [height, width, 3], and what is heard while it is seen, float32 [samples, 2]."""

    pixels: Pixels
    sound: Samples


THREADS: Final = 2
"""Fixed: the same pictures give the same bytes on every machine."""
PRESET: Final = "veryfast"
CRF: Final = 23
SOUND_BPS: Final = 128_000


def write_video(path: Path, frames: Iterable[Frame], fps: int, crf: int = CRF, sound_bps: int = SOUND_BPS) -> int:
    """Write frames of one even size as a video; return how many. An error leaves no file.

    Args:
        path: The new file.
        frames: Pictures with their sound, in their order.
        fps: Frames a second.
        crf: Constant rate factor of x264, 0 to 51: the larger, the smaller and coarser.
        sound_bps: Bits a second of the sound.

    Raises:
        RecordingError: the encoder is not installed, or the file cannot be written.
    """
    try:
        import av
    except ImportError:
        raise RecordingError("video: module av: not installed: pip install 'simconsole[video]'") from None
    count = 0
    try:
        with replaced(path) as draft, av.open(str(draft), "w", format="mp4") as file:
            stream = file.add_stream("libx264", rate=fps, options={"preset": PRESET, "crf": f"{crf}"})
            stream.pix_fmt = "yuv420p"
            stream.codec_context.thread_count = THREADS
            voice = _sound_stream(file, sound_bps)
            for pixels, sound in frames:
                if count == 0:
                    stream.height, stream.width = pixels.shape[:2]
                file.mux(stream.encode(av.VideoFrame.from_ndarray(pixels, format="rgb24")))
                file.mux(voice.encode(_heard(sound)))
                count += 1
            file.mux(stream.encode(None))
            file.mux(voice.encode(None))
    except (OSError, av.FFmpegError) as problem:
        raise RecordingError(f"{path}: cannot be written: {getattr(problem, 'strerror', None) or problem}") from None
    return count


def _sound_stream(file: Any, sound_bps: int) -> Any:
    voice = file.add_stream("aac", rate=RATE_HZ, layout="stereo", bit_rate=sound_bps)
    voice.codec_context.thread_count = 1
    return voice


def _heard(sound: Samples) -> Any:
    import av

    frame = av.AudioFrame.from_ndarray(np.ascontiguousarray(sound.T), format="fltp", layout="stereo")
    frame.sample_rate = RATE_HZ
    return frame


def write_png(path: Path, pixels: Pixels) -> None:
    """Write one picture, uint8 [height, width, 3].

    Raises:
        RecordingError: the file cannot be written.
    """
    import pygame

    height, width = pixels.shape[:2]
    content = io.BytesIO()
    pygame.image.save(pygame.image.frombytes(pixels.tobytes(), (width, height), "RGB"), content, "picture.png")
    try:
        write_atomically(path, content.getvalue(), durable=False)
    except OSError as problem:
        raise RecordingError(f"{path}: cannot be written: {problem.strerror}") from None
