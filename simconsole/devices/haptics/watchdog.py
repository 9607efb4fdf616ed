"""A small process beside the console that ends every force when the console's heartbeat stops.

The console counts a heartbeat in shared memory whenever it starts its effects again (every 50 ms; watchdog_client.py).
When 100 ms pass without one while force is on, or when the console ends, the watchdog stops every effect of the wheel:
only its owner may change an effect, but any process may stop it (`input_ff_event`, drivers/input/ff-core.c). Effects
last 200 ms at most, so that force also ends where there is no watchdog or it is late.

Run as `python -m simconsole.devices.haptics.watchdog`. A line of JSON on standard input says what to watch; when the
input closes, the console has ended. Loads neither numpy nor any other large library.
"""

import json
import mmap
import os
import select
import signal
import sys
import time
from pathlib import Path
from typing import Final

from simconsole.devices.sources.event_nodes import effect_slots, open_node, stop_effects
from simconsole.processes.lifetimes import read_told
from simconsole.values.errors import DeviceError

POLL_S: Final = 0.02
STALL_S: Final = 0.1
RETRY_S: Final = 0.5
BEATS, FORCE = 0, 1
"""Indices of the int64 values in shared memory: heartbeats so far; 1 while force is on."""
MEMORY_BYTES: Final = 16


class StallDetector:
    """Decides when a missing heartbeat is a stall. Pure: time comes in."""

    def __init__(self) -> None:
        self._seen = -1
        self._since_s = 0.0
        self._done = False

    def look(self, beats: int, force: bool, now_s: float) -> bool:
        """Return whether effects must be stopped now; again at each look until `stopped` is called."""
        if beats != self._seen:
            self._seen, self._since_s, self._done = beats, now_s, False
        return force and not self._done and now_s - self._since_s > STALL_S

    def stopped(self) -> None:
        """Note that the effects of this stall have been stopped."""
        self._done = True


class EffectStopper:
    """The wheel's event device, opened as soon as it is there, so that stopping its effects takes no search."""

    def __init__(self, identity: tuple[int, int]) -> None:
        self._identity = identity
        self._descriptor: int | None = None
        self._slots = 0
        self._next_s = 0.0

    def ready(self, now_s: float) -> None:
        """Open the device where it is not open, a few times a second."""
        if self._descriptor is not None or now_s < self._next_s:
            return
        self._next_s = now_s + RETRY_S
        try:
            self._descriptor = open_node(self._identity)
            self._slots = effect_slots(self._descriptor)
        except (DeviceError, OSError):
            self._close()

    def stop_all(self) -> bool:
        """Stop every effect; return whether the device took it."""
        self.ready(time.monotonic())
        if self._descriptor is None:
            return False
        try:
            stop_effects(self._descriptor, self._slots)
        except OSError:  # unplugged, and perhaps back under another number
            self._close()
            return False
        return True

    def _close(self) -> None:
        if self._descriptor is not None:
            os.close(self._descriptor)
        self._descriptor = None


def watch(memory: "memoryview[int]", stopper: EffectStopper, pipe: int) -> None:
    """Watch until `pipe` ends; where force is on then, stop it."""
    stall = StallDetector()
    while True:
        ended = bool(select.select([pipe], [], [], POLL_S)[0])
        now_s = time.monotonic()
        stopper.ready(now_s)
        beats, force = memory[BEATS], memory[FORCE] != 0
        if ended:
            if force:
                stopper.stop_all()
            return
        if stall.look(beats, force, now_s) and stopper.stop_all():
            stall.stopped()


def main() -> int:
    """Run the watchdog; return its exit code."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the console handles Ctrl-C; the pipe tells when to end
    line = read_told()
    if not line:
        return 1
    told = json.loads(line)
    descriptor = os.open(told["memory"], os.O_RDONLY)
    memory = mmap.mmap(descriptor, MEMORY_BYTES, access=mmap.ACCESS_READ)
    os.close(descriptor)
    Path(told["memory"]).unlink(missing_ok=True)  # both sides have it mapped: no file stays behind, whichever is killed
    watch(memoryview(memory).cast("q"), EffectStopper((told["vendor_id"], told["product_id"])), sys.stdin.fileno())
    return 0


if __name__ == "__main__":
    sys.exit(main())
