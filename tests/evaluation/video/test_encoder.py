"""Files of pictures, decoded again."""

import sys
from collections.abc import Iterator
from pathlib import Path

import av
import numpy as np
import pygame
import pytest

from simconsole.evaluation.video.encoder import Pixels, write_png, write_video
from simconsole.values.errors import RecordingError


def ramp(index: int) -> Pixels:
    picture = np.zeros((120, 160, 3), np.uint8)
    picture[:, :, 0] = 10 * index
    picture[:60, :, 1] = 200
    return picture


def frames(count: int = 12) -> Iterator[Pixels]:
    return (ramp(index) for index in range(count))


def test_what_went_in_comes_out(tmp_path: Path) -> None:
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


def test_the_same_pictures_give_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.mp4", "b.mp4"):
        write_video(tmp_path / name, frames(), 30)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()


def test_an_error_leaves_no_file(tmp_path: Path) -> None:
    def broken() -> Iterator[Pixels]:
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
