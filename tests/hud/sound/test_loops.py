import numpy as np
import pytest

from simconsole.hud.sound.loops import RATE_HZ, Needle, noise_loop


def share_between(loop: np.ndarray[tuple[int], np.dtype[np.float32]], low_hz: float, high_hz: float) -> float:
    power = np.abs(np.fft.rfft(loop)) ** 2
    hz = np.fft.rfftfreq(len(loop), 1.0 / RATE_HZ)
    return float(power[(hz >= low_hz) & (hz <= high_hz)].sum() / power.sum())


def test_noise_lies_in_its_band_and_has_an_effective_value_of_one() -> None:
    loop = noise_loop(1, 200.0, 1_000.0)
    assert np.sqrt(np.mean(np.square(loop))) == pytest.approx(1.0, abs=1e-5)
    assert share_between(loop, 100.0, 2_000.0) > 0.95
    assert (noise_loop(1, 200.0, 1_000.0) == loop).all()
    assert not (noise_loop(2, 200.0, 1_000.0) == loop).all()


def test_a_falling_spectrum_has_less_above() -> None:
    flat, falling = noise_loop(3, 100.0, 4_000.0), noise_loop(3, 100.0, 4_000.0, -6.0)
    assert share_between(falling, 1_000.0, 8_000.0) < 0.3 * share_between(flat, 1_000.0, 8_000.0)


def test_the_end_fits_the_start() -> None:
    loop = noise_loop(4, 50.0, 500.0)
    steps = np.abs(np.diff(loop))
    assert abs(loop[0] - loop[-1]) <= steps.max()


def test_a_needle_reads_on_where_it_stopped() -> None:
    loop = noise_loop(5, 50.0, 500.0)
    needle, pieces = Needle(loop), Needle(loop)
    whole = needle.read(3_000, 1.3)
    assert np.concatenate([pieces.read(1_000, 1.3) for _ in range(3)]) == pytest.approx(whole, abs=1e-4)
    assert Needle(loop).read(10) == pytest.approx(loop[:10])


def test_pitch_two_is_an_octave_higher() -> None:
    tone = np.sin(2.0 * np.pi * 400.0 * np.arange(RATE_HZ) / RATE_HZ).astype(np.float32)
    read = Needle(tone).read(RATE_HZ, 2.0)
    assert np.abs(np.fft.rfft(read)).argmax() == 800


def test_a_needle_goes_round() -> None:
    loop = np.arange(8, dtype=np.float32)
    assert Needle(loop, 0.75).read(4) == pytest.approx([6.0, 7.0, 0.0, 1.0])
