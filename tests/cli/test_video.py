"""`simconsole video` as people run it."""

from pathlib import Path

import pygame
import pytest

from tests.drives.console import complaint, results, simconsole, within


def test_a_video_shows_the_drive(short: Path, tmp_path: Path) -> None:
    import av

    path = tmp_path / "drive.mp4"
    words = ("--from", 1, "--to", 1.5, "--fps", 10, "--size", "480x320", "--out", path)
    done = simconsole("video", short, *words, "--json")
    assert done.returncode == 0, done.stderr
    assert results(done) == {
        "video": str(path), "frames": 6, "fps": 10, "bytes": path.stat().st_size, "problems": [],
    }  # fmt: skip
    assert f"{path}: 6 frames, 0.6 s\n" in done.stderr
    with av.open(str(path)) as file:
        decoded = [frame.to_ndarray(format="rgb24") for frame in file.decode(video=0)]
    assert [picture.shape for picture in decoded] == [(320, 480, 3)] * 6


def test_one_moment_is_a_picture(short: Path, tmp_path: Path) -> None:
    path = tmp_path / "moment.png"
    done = simconsole("video", short, "--png", 2, path, "--size", "480x320", "--camera", "chase", "--json")
    assert done.returncode == 0, done.stderr
    assert results(done) == {"picture": str(path), "t_s": 2.0, "tick": 500}
    assert pygame.image.load(path).get_size() == (480, 320)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--size", "641x480"), "--size: value '641x480': WIDTHxHEIGHT, both even and from 320 to 4096"),
        (("--size", "large"), "--size: value 'large': "),
        (("--fps", 0), "--fps: value 0: 1 to 240"),
        (("--from", -1), "--from: value -1: a time in s, at least 0"),
        (("--from", 2, "--to", 1), "--to: value 1: a time in s after --from (2)"),
    ],
)
def test_what_cannot_be_meant_is_one_line(short: Path, words: tuple[object, ...], told: str) -> None:
    assert told in complaint(within("video", short, *words))
