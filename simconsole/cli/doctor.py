"""`simconsole doctor`: what this machine has and lacks, without opening a device or port."""

import os
import platform
import sys
from argparse import Namespace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from simconsole.cli.outcome import Outcome, table
from simconsole.values.version import __version__

LIBRARIES = ("numpy", "numba", "pygame-ce", "websockets", "msgspec", "orjson", "rerun-sdk", "matplotlib", "pyyaml")

_LOCAL_PROGRAMS = (
    "as shipped any program of this machine may use a drive's rosbridge: watch, talk to other clients, press the "
    "emergency stop, ask for modes, pause and reset, set parameters, and command while nobody else does; with "
    "outputs.bridge.tokens only what its token allows"
)


def doctor(options: Namespace) -> Outcome:
    """Report versions and what of the machine the console could use. Nothing found here stops a headless drive."""
    found = {
        "simconsole": __version__,
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "cores": str(os.cpu_count()),
        **{name: _version(name) for name in LIBRARIES},
        "input devices": _yes(
            sys.platform != "linux" or Path("/dev/input").is_dir(),
            "no wheel can be read; virtual, trace and script can",
        ),
        "display": _yes(bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")), "no window; PNG works"),
        "shared memory": _yes(Path("/dev/shm").is_dir(), "a temporary folder takes its place"),
        "real-time scheduling": _yes(_may_use_fifo(), "the tick loop runs without it, later under load"),
        **_sumo(),
        "local programs": _LOCAL_PROGRAMS,
    }
    return Outcome(0, found, table(list(found.items())))


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "missing"


def _sumo() -> dict[str, str]:
    """Return a row for each part of SUMO: two back ends, the program behind one of them, and netconvert."""
    from simconsole.world.sumo.netconvert import netconvert
    from simconsole.world.sumo_traffic.engines import has, sumo_program

    backend = "environment.traffic.sumo with backend"
    return {
        "libsumo": _version_or("libsumo", has("libsumo"), f"{backend} libsumo needs the extra `sumo`"),
        "traci": _version_or("traci", has("traci"), f"{backend} traci needs the extra `sumo`"),
        "program sumo": _yes(sumo_program() is not None, f"{backend} traci needs it, or the address of one elsewhere"),
        "netconvert": _yes(netconvert() is not None, "OpenDRIVE and OpenStreetMap cannot be imported"),
    }


def _version_or(name: str, is_there: bool, otherwise: str) -> str:
    return f"yes: {_version(name)}" if is_there else f"no: {otherwise}"


def _yes(has: bool, otherwise: str) -> str:
    return "yes" if has else f"no: {otherwise}"


def _may_use_fifo() -> bool:
    if sys.platform != "linux":
        return False
    import resource

    return os.geteuid() == 0 or resource.getrlimit(resource.RLIMIT_RTPRIO)[0] != 0
