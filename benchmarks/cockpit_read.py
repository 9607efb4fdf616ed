"""What reading the full cockpit costs in a tick: wheel, three pedals, lever, 23 buttons and the hat through SDL.

Run: python benchmarks/cockpit_read.py [--ticks N]

The cockpit is the T500 RS and TH8 RS as SDL's virtual devices; moving them is not counted, emptying SDL's queue of what
that made is. Bar: at most 20 us a tick. Beside it what the pipeline does with the sample (`calibrate`, compiled).
"""

import argparse
import json
import statistics
import time
from collections.abc import Callable

from simconsole.devices.calibration.calibrator import calibrate
from simconsole.devices.calibration.cockpit_settings import NOBODY, cockpit_settings
from simconsole.devices.calibration.inverse_calibration import Intent, raw_sample
from simconsole.devices.sources.sdl_source import SdlSource
from simconsole.devices.sources.virtual_cockpit import VirtualCockpit
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import load
from simconsole.values.host.jit import compiled

TICK_HZ = 250
BAR_US = 20.0


def timed(ticks: int, before: Callable[[int], None], work: Callable[[int], object]) -> dict[str, float]:
    """Return the spread of `work` in us of this thread's CPU time; `before` is not counted."""
    spent = []
    for tick in range(ticks):
        before(tick)
        start = time.thread_time_ns()
        work(tick)
        spent.append((time.thread_time_ns() - start) / 1000.0)
    spent.sort()
    return {
        "median_us": round(statistics.median(spent), 1),
        "mean_us": round(statistics.mean(spent), 1),
        "p99_us": round(spent[len(spent) * 99 // 100], 1),
    }


def main() -> None:
    """Print one line for each case and one JSON object."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--ticks", type=int, default=5000)
    ticks = parser.parse_args().ticks
    cockpit = load("devices", "t500rs_th8rs", CockpitProfile)
    numbers = cockpit_settings(cockpit, TICK_HZ)
    plugged = VirtualCockpit(cockpit)
    source = SdlSource(cockpit)

    def still(tick: int) -> None:
        return

    def move(tick: int) -> None:
        wave = tick % 100 / 100.0
        gear = float(tick // 50 % 7)
        plugged.write(
            raw_sample(Intent(4.0 * wave - 2.0, wave, 1.0 - wave, wave, 0.0, gear, tick // 25 % 512), numbers)
        )

    twin = compiled(calibrate)
    sample = source.poll(0)
    twin(sample, sample, NOBODY, 0.0, numbers, 0.004)
    results = {
        "still": timed(ticks, still, source.poll),
        "moving": timed(ticks, move, source.poll),
        "calibrate": timed(ticks, still, lambda tick: twin(sample, sample, NOBODY, 0.0, numbers, 0.004)),
    }
    source.close()
    plugged.close()
    for name, result in results.items():
        print(name, result, flush=True)
    print(json.dumps({"bar_us": BAR_US, **results}))


if __name__ == "__main__":
    main()
