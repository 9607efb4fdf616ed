"""Files of pictures, decoded again."""

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pygame
import pytest

from simconsole.evaluation.video.encoder import Frame, Pixels, write_png, write_video
from simconsole.hud.sound.directions import Samples
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.values.errors import RecordingError


def ramp(index: int) -> Pixels:
    picture = np.zeros((120, 160, 3), np.uint8)
    picture[:, :, 0] = 10 * index
    picture[:60, :, 1] = 200
    return picture


def tone(index: int, fps: int) -> Samples:
    times_s = np.arange(index * RATE_HZ // fps, (index + 1) * RATE_HZ // fps) / RATE_HZ
    return np.stack([0.5 * np.sin(2.0 * np.pi * hz * times_s) for hz in (400.0, 900.0)], axis=1).astype(np.float32)


def frames(count: int = 12, fps: int = 25) -> Iterator[Frame]:
    return (Frame(ramp(index % 12), tone(index, fps)) for index in range(count))


def test_what_went_in_comes_out(tmp_path: Path) -> None:
    import av

    path = tmp_path / "a.mp4"
    assert write_video(path, frames(), 25) == 12
    with av.open(str(path)) as file:
        stream = file.streams.video[0]
        assert (stream.codec_context.name, stream.average_rate, stream.width, stream.height) == ("h264", 25, 160, 120)
        decoded = [frame.to_ndarray(format="rgb24") for frame in file.decode(stream)]
    assert len(decoded) == 12
    for index, picture in enumerate(decoded):
        assert np.abs(picture.astype(int) - ramp(index)).mean() < 6.0
    assert [path.name for path in tmp_path.iterdir()] == ["a.mp4"]


def test_sound_goes_with_the_pictures(tmp_path: Path) -> None:
    import av

    path = tmp_path / "a.mp4"
    write_video(path, frames(50), 25)
    with av.open(str(path)) as file:
        voice = file.streams.audio[0]
        assert (voice.codec_context.name, voice.rate, voice.channels) == ("aac", RATE_HZ, 2)
        decoded = np.concatenate([frame.to_ndarray() for frame in file.decode(voice)], axis=1)
    assert decoded.shape[1] / RATE_HZ == pytest.approx(2.0, abs=0.05)
    for column, hz in zip(decoded, (400.0, 900.0), strict=True):
        middle = column[RATE_HZ // 2 : 3 * RATE_HZ // 2]
        assert np.abs(np.fft.rfft(middle)).argmax() == pytest.approx(hz, abs=2.0)


def test_the_same_pictures_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.mp4", "b.mp4"):
        write_video(tmp_path / name, frames(), 30)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()


def test_an_error_leaves_no_file(tmp_path: Path) -> None:
    def broken() -> Iterator[Frame]:
        yield from frames(3)
        raise RecordingError("the log ends here")

    with pytest.raises(RecordingError, match="the log ends here"):
        write_video(tmp_path / "a.mp4", broken(), 30)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(RecordingError, match="cannot be written: No such file or directory"):
        write_video(tmp_path / "nowhere" / "a.mp4", frames(), 30)


def test_without_the_encoder_it_is_said_how_to_get_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(RecordingError, match=r"pip install 'simconsole\[video\]'"):
        write_video(tmp_path / "a.mp4", frames(), 30)


def test_a_png_holds_the_picture_itself(tmp_path: Path) -> None:
    write_png(tmp_path / "a.png", ramp(7))
    seen = pygame.surfarray.array3d(pygame.image.load(tmp_path / "a.png")).swapaxes(0, 1)
    assert (seen == ramp(7)).all()
    with pytest.raises(RecordingError, match="cannot be written: No such file"):
        write_png(tmp_path / "nowhere" / "a.png", ramp(7))
