"""The console's side of the watchdog: a motor that sends a heartbeat with every start of its effects."""

import json
import mmap
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Final

from simconsole.devices.force_feedback.motor import EFFECT_S, Capability, HapticPort
from simconsole.devices.haptics.watchdog import BEATS, FORCE, MEMORY_BYTES
from simconsole.processes.lifetimes import end, spawn
from simconsole.processes.shared_memory import PREFIX
from simconsole.values.errors import DeviceError

END_S: Final = 2.0


class Watchdog:
    """The watchdog of a cockpit's wheel; it stays the same when the wheel is plugged in again."""

    def __init__(self, identity: tuple[int, int]) -> None:
        """Start it.

        Args:
            identity: The wheel's USB vendor and product id.

        Raises:
            DeviceError: its process cannot be started.
        """
        memory, prefix = Path("/dev/shm"), f"{PREFIX}{os.getpid()}-beat-"
        descriptor, name = tempfile.mkstemp(prefix=prefix, dir=memory if memory.is_dir() else None)
        self._path = Path(name)
        self._process: subprocess.Popen[bytes] | None = None
        try:
            os.ftruncate(descriptor, MEMORY_BYTES)
            self._words = memoryview(mmap.mmap(descriptor, MEMORY_BYTES)).cast("q")
            self._start(identity)
        except OSError as error:
            self._path.unlink(missing_ok=True)
            raise DeviceError(f"wheel: watchdog: {error.strerror}: a process beside this one") from error
        finally:
            os.close(descriptor)

    @property
    def process_id(self) -> int | None:
        """Id of its process; None when it has ended."""
        return None if self._process is None or self._process.poll() is not None else self._process.pid

    def beat(self, force: bool) -> None:
        """Count a heartbeat, and tell whether force stays on the wheel."""
        self._words[FORCE] = int(force)
        self._words[BEATS] += 1

    def close(self) -> None:
        """End its process. A second call does nothing."""
        process, self._process = self._process, None
        if process is None:
            return
        self.beat(force=False)
        end([process], END_S)
        self._path.unlink(missing_ok=True)

    def _start(self, identity: tuple[int, int]) -> None:
        told = {"memory": str(self._path), "vendor_id": identity[0], "product_id": identity[1]}
        # A process group of its own: a signal that stops or ends the console's group must leave the watchdog running.
        self._process = spawn(["-m", "simconsole.devices.haptics.watchdog"], told=json.dumps(told).encode() + b"\n")


class WatchdogPort:
    """A motor that sends a heartbeat with every start. A `HapticPort`."""

    def __init__(self, port: HapticPort, watchdog: Watchdog) -> None:
        self._port = port
        self._watchdog = watchdog

    @property
    def capability(self) -> Capability:
        """What the motor can do."""
        return self._port.capability

    def write(self, level: float) -> None:
        """Set the level."""
        self._port.write(level)

    def start(self) -> None:
        """Send a heartbeat, then start the effects."""
        self._watchdog.beat(force=True)  # first: a console that stops in between is watched already
        self._port.start()

    def stop(self) -> None:
        """End them, and tell the watchdog that no force is left."""
        self._port.stop()
        self._watchdog.beat(force=False)

    def close(self) -> None:
        """Release the motor. The watchdog stays for a wheel that is plugged in again."""
        self._port.close()
        self._watchdog.beat(force=False)


def open_watchdog(identity: tuple[int, int], say: Callable[[str], None]) -> Watchdog | None:
    """Start a watchdog; where none can be started, say so: effects still end by themselves."""
    reason: object = "only on Linux may another process stop a motor"
    if sys.platform == "linux":
        try:
            return Watchdog(identity)
        except DeviceError as error:
            reason = error
    say(f"no watchdog: {reason}; forces end by themselves after {EFFECT_S:g} s")
    return None


def with_watchdog(port: HapticPort, watchdog: Watchdog | None) -> HapticPort:
    """Return the motor with its watchdog; one without force, or without a watchdog, as it is."""
    return port if watchdog is None or not port.capability.constant else WatchdogPort(port, watchdog)
