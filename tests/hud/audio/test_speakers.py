"""SDL's own device drivers that need no card: what was played lies in a file."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from simconsole.hud.audio.speakers import Speakers
from simconsole.hud.sound.directions import LOW, NAMES
from simconsole.hud.sound.loops import RATE_HZ
from simconsole.profiles.view import SoundProfile
from simconsole.values.errors import WorkerError

PROGRAM = """
import sys, time
import numpy as np
from simconsole.hud.audio.speakers import Speakers
from simconsole.profiles.view import SoundProfile

speakers = Speakers(SoundProfile(speakers=int(sys.argv[1])))
times_s = np.arange(1024 * 40) / 48000
hz = (200.0, 300.0, 400.0, 500.0, 600.0, 700.0)
tones = np.stack([0.5 * np.sin(2 * np.pi * one * times_s) for one in hz], axis=1).astype(np.float32)
for start in range(0, len(tones), 1024):
    while not speakers.wants():
        time.sleep(0.0005)
    speakers.play(tones[start : start + 1024])
while not speakers.wants():
    time.sleep(0.001)
time.sleep(0.1)
print(speakers.channels)
speakers.close()
"""


def recorded(folder: Path, columns: int) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    path = folder / "sound.raw"
    around = {"SDL_AUDIODRIVER": "disk", "SDL_DISKAUDIOFILE": str(path), "PATH": "", "HOME": str(folder)}
    words = [sys.executable, "-c", PROGRAM, str(columns)]
    done = subprocess.run(words, env=around, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) == columns, "nothing but what this program says itself"
    return np.frombuffer(path.read_bytes(), "<i2").reshape(-1, columns) / 32767.0


def tones_hz(column: np.ndarray[tuple[int], np.dtype[np.float64]], count: int) -> list[int]:
    sounding = column[np.abs(column) > 1e-3]
    loud = column[np.flatnonzero(np.abs(column) > 1e-3)[0] :][: RATE_HZ // 2] if sounding.size else column
    spectrum = np.abs(np.fft.rfft(loud * np.hanning(len(loud))))
    found = []
    for _ in range(count):
        peak = int(spectrum.argmax())
        found.append(round(peak * RATE_HZ / len(loud) / 10.0) * 10)
        spectrum[max(0, peak - 20) : peak + 21] = 0.0
    return sorted(found)


def test_six_columns_come_out_as_they_went_in(tmp_path: Path) -> None:
    sound = recorded(tmp_path, 6)
    assert [tones_hz(sound[:, channel], 1) for channel in range(6)] == [[200], [300], [400], [500], [600], [700]]


def test_two_loudspeakers_have_the_others_folded_in(tmp_path: Path) -> None:
    sound = recorded(tmp_path, 2)
    assert tones_hz(sound[:, 0], 3) == [200, 400, 600]
    assert tones_hz(sound[:, 1], 3) == [300, 400, 700]


def test_a_missing_device_is_one_line_and_leaves_standard_error_as_it_was(
    capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    with pytest.raises(WorkerError, match="sound: no device 'of this name'"):
        Speakers(SoundProfile(device="of this name"))
    assert capfd.readouterr() == ("", "")


def test_names_are_those_of_the_columns() -> None:
    assert NAMES[LOW] == "low frequencies"
    assert len(NAMES) == 6
