"""The sound of a video is that of the drive, frame by frame."""

import math

import numpy as np
import pytest

from simconsole.evaluation.video.drive_sound import DriveSound
from simconsole.evaluation.video.moments import VideoFrame
from simconsole.hud.driver_view.motion import shown_vehicle
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.session.resolution import load_session, resolve
from tests.hud.test_view import snapshot


def moment(frame: int, rpm: float) -> VideoFrame:
    now = snapshot(vehicle__engine_radps=rpm * math.pi / 30.0, vehicle__engine_running=1.0, command__throttle=0.5)
    now = now._replace(tick=10 * frame)
    return VideoFrame(now.t_s, now, shown_vehicle(now))


@pytest.mark.parametrize("fps", [24, 25, 30, 60])
def test_frames_have_as_many_samples_as_they_last(fps: int) -> None:
    sound = DriveSound(resolve(load_session("demo")), fps)
    blocks = [sound.frame(moment(number, 1_000.0)) for number in range(2 * fps + 1)]
    assert sum(len(block) for block in blocks) == (2 * fps + 1) * RATE_HZ // fps
    assert max(abs(len(block) - RATE_HZ / fps) for block in blocks) < 1.0


def test_the_engine_is_heard_at_its_speed() -> None:
    sound = DriveSound(resolve(load_session("demo")), 25)
    heard = np.concatenate([sound.frame(moment(number, 3_000.0)) for number in range(50)])[RATE_HZ // 5 :]
    for column in heard.T:
        spectrum = np.abs(np.fft.rfft(column * np.hanning(len(column))))
        assert spectrum.argmax() * RATE_HZ / len(column) == pytest.approx(100.0, rel=0.01)


def test_what_rolls_without_an_engine_is_heard_by_its_way_only() -> None:
    sound = DriveSound(resolve(load_session("roll_a_ball")), 25)
    assert not np.concatenate([sound.frame(moment(number, 3_000.0)) for number in range(5)]).any()
