"""Settings of a wheel's Linux driver beside its effects: gain and autocentre in sysfs, found, saved and restored.

Neither SDL nor evdev can read them; hid-lg4ff, new-lg4ff and hid-tmff2 offer them as files, 0 to 65535. All of it is
optional: where a file is missing or forbidden, what the profile says is left behind.
"""

from pathlib import Path
from typing import Final

from simconsole.devices.force_feedback.motor import Capability, HapticPort

CLASS: Final = Path("/sys/class/input")
NAMES: Final = ("gain", "autocenter")
_MOST: Final = 65_535
_DIGITS: Final = 16


def driver_folder(identity: tuple[int, int]) -> Path | None:
    """Return the driver's folder of the event device with this USB vendor and product id, None where there is none."""
    try:
        events = sorted(path for path in CLASS.iterdir() if path.name.startswith("event"))
    except OSError:
        return None
    for event in events:
        ids = tuple(_number(event / "device" / "id" / name, 16) for name in ("vendor", "product"))
        if ids == identity and (event / "device" / "device").is_dir():
            return event / "device" / "device"
    return None


def read_settings(identity: tuple[int, int]) -> dict[Path, int]:
    """Return the driver's settings by their files; empty where it has none that may be read."""
    folder = driver_folder(identity)
    if folder is None:
        return {}
    values = {folder / name: _number(folder / name, 10) for name in NAMES}
    return {path: value for path, value in values.items() if value is not None and 0 <= value <= _MOST}


class RestoringPort:
    """A motor that leaves its driver's settings as they were."""

    def __init__(self, port: HapticPort, before: dict[Path, int]) -> None:
        self._port = port
        self._before = before
        self.write = port.write
        self.start = port.start
        self.stop = port.stop

    @property
    def capability(self) -> Capability:
        """What the motor can do."""
        return self._port.capability

    def close(self) -> None:
        """Close the motor, then put the settings back; a wheel that is gone takes them with it."""
        try:
            self._port.close()
        finally:
            for path, value in self._before.items():
                _put(path, value)
            self._before = {}


def _number(path: Path, base: int) -> int | None:
    try:
        with path.open("rb") as file:
            return int(file.read(_DIGITS), base)
    except (OSError, ValueError):
        return None


def _put(path: Path, value: int) -> None:
    try:
        path.write_text(f"{value}\n", "ascii")
    except OSError:
        return
