"""Where device samples come from: one protocol, and a lazy registry of its implementations."""

from pathlib import Path

from simconsole.devices.calibration.cockpit_settings import cockpit_settings
from simconsole.devices.synthetic.keyboard import KeyboardSource, Keys
from simconsole.devices.synthetic.script import ScriptSource
from simconsole.devices.synthetic.steering_assistance import assistance_of
from simconsole.profiles.device import CockpitProfile
from simconsole.profiles.files.loader import find, load
from simconsole.profiles.parts.script import ScriptProfile
from simconsole.values.errors import ProfileError
from simconsole.values.protocols import DeviceSource

DRIVERS = "sdl, trace:FILE, script:FILE or keyboard"


def open_source(driver: str, cockpit: CockpitProfile, *, tick_hz: int, keys: Keys | None = None) -> DeviceSource:
    """Open the cockpit that `driver` names; SDL is loaded only where it is asked for.

    Args:
        driver: `sdl`, `trace:FILE`, `script:FILE` or `keyboard`.
        cockpit: The profile that says what the axes mean.
        tick_hz: The session's tick rate.
        keys: Where the keyboard's keys come from; only for `keyboard`.

    Raises:
        ProfileError: no such driver, or its file cannot be used.
        DeviceError: a device is missing or cannot be used.
    """
    kind, _, name = driver.partition(":")
    if kind == "sdl" and not name:
        from simconsole.devices.sources.sdl_source import SdlSource

        return SdlSource(cockpit)
    if kind == "trace" and name:
        from simconsole.devices.sources.trace_files import TraceSource

        return TraceSource(Path(name), tick_hz=tick_hz)
    if kind == "script" and name:
        script = load("devices", name, ScriptProfile)
        origin = str(find("devices", name))
        return ScriptSource(script, cockpit_settings(cockpit, tick_hz), tick_hz=tick_hz, name=origin)
    if kind == "keyboard" and not name:
        if keys is None:
            raise ProfileError("driver: value keyboard: a drive with a window, which owns the keyboard")
        assistance = assistance_of(cockpit.wheel)
        if assistance is None:
            raise ProfileError(f"{cockpit.title}: wheel.assistance: value missing: given, where keys steer")
        return KeyboardSource(keys, cockpit_settings(cockpit, tick_hz), assistance, tick_hz=tick_hz)
    raise ProfileError(f"driver: value {driver!r}: {DRIVERS}")
