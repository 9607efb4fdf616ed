"""The watchdog beside the console: when silence is a stall, and that it comes and goes with its console.

What it does to a wheel is shown on the kernel's interface in tests/faults/test_force_feedback.py.
"""

import subprocess
import sys

from simconsole.devices.haptics.watchdog import STALL_S, StallDetector


def test_silence_is_a_stall_after_100_ms_and_once() -> None:
    stall = StallDetector()
    assert not stall.look(1, True, 10.0)
    assert not stall.look(1, True, 10.0 + STALL_S)
    assert stall.look(1, True, 10.001 + STALL_S)
    assert stall.look(1, True, 10.02 + STALL_S), "until it has been stopped"
    stall.stopped()
    assert not stall.look(1, True, 12.0)
    assert not stall.look(2, True, 12.1), "it lives again"
    assert stall.look(2, True, 12.3), "and hangs again"


def test_beats_in_time_and_silence_without_force_are_none() -> None:
    stall = StallDetector()
    assert not any(stall.look(beat, True, 0.05 * beat) for beat in range(100))
    assert not stall.look(99, False, 100.0)


def test_watchdog_loads_nothing_large() -> None:
    large = "{'numpy', 'msgspec', 'pygame', 'simconsole.values.signals'}"
    code = f"import sys, simconsole.devices.haptics.watchdog; print({large} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
