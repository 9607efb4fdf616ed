"""What is known of a drive before its first tick: time, machine, packages, source, devices, what people say of it."""

import os
import platform
import subprocess
from collections.abc import Sequence
from functools import cache
from hashlib import sha256
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Final

import msgspec

from simconsole.recording.bundles.provenance import (
    Device,
    Given,
    Machine,
    Provenance,
    Source,
    TorqueShare,
    utc_now,
)
from simconsole.values.protocols import DeviceIdentity
from simconsole.values.version import __version__

PACKAGES: Final = (
    "numpy",
    "numba",
    "llvmlite",
    "pygame-ce",
    "msgspec",
    "PyYAML",
    "orjson",
    "websockets",
    "python-can",
    "cantools",
)
"""Whose versions a drive's result may depend on: those that compute it, and those that its inputs come through."""

GIT_S: Final = 5.0
"""Longest time that one question to git may take; a drive does not wait longer to know what it is made of."""

_PACKAGE: Final = Path(__file__).resolve().parents[1]


def provenance_at_start(title: str, given: Given, shares: Sequence[tuple[float, float]] = ()) -> Provenance:
    """Return all that is known before any device is open.

    Args:
        title: of the session.
        given: what whoever starts the drive says of it.
        shares: speeds in km/h, and the share of the car's torque that the wheel bears there.

    Raises:
        RecordingError: a text of `given` is too long.
    """
    given.checked()
    return Provenance(
        started_utc=utc_now(),
        title=title,
        participant=given.participant,
        trial=given.trial,
        notes=given.notes,
        machine=_machine(),
        source=_source(_PACKAGE),
        torque_shares=tuple(TorqueShare(speed_kmh=speed_kmh, share=share) for speed_kmh, share in shares),
    )


def with_devices(known: Provenance, identities: Sequence[DeviceIdentity]) -> Provenance:
    """Return what is known, with the devices that were found."""
    return msgspec.structs.replace(known, devices=tuple(Device(**found._asdict()) for found in identities))


@cache
def package_versions() -> dict[str, str]:
    """Return the versions of simconsole and of PACKAGES, less those that are not installed."""
    found = {"simconsole": __version__}
    for name in PACKAGES:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def host_facts() -> dict[str, str]:
    """Return versions and machine as plain text, for a report that is sent in."""
    machine = _machine()
    return {
        **package_versions(),
        "platform": machine.platform,
        "kernel": machine.kernel,
        "cpu": machine.cpu,
        "python": machine.python,
    }


@cache
def _machine() -> Machine:
    return Machine(
        platform=f"{platform.system()} {platform.machine()}",
        kernel=platform.release(),
        cpu=_cpu(),
        cpus=os.cpu_count() or 0,
        python=f"{platform.python_implementation()} {platform.python_version()}",
    )


def _cpu() -> str:
    """Return the processor's model; its architecture where the system does not say more."""
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    models = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(models, platform.machine())


@cache
def _source(package: Path) -> Source:
    text = sha256()
    for path in sorted(package.rglob("*.py")):
        content = path.read_bytes()
        text.update(f"{path.relative_to(package).as_posix()}\0{len(content)}\0".encode() + content)
    # A package may lie in a folder that the checkout around it ignores, as site-packages in a project's .venv.
    tracked = _git(package, "ls-files", "--error-unmatch", "--", "__init__.py") is not None
    commit = _git(package, "rev-parse", "HEAD") if tracked else None
    changes = _git(package, "status", "--porcelain", "--", ".") if tracked else None
    return Source(
        version=__version__,
        sha256=text.hexdigest(),
        commit=commit,
        changed=None if changes is None else bool(changes),
    )


def _git(folder: Path, *words: str) -> str | None:
    """Return what git says of a folder, None where it says nothing good or is not there."""
    environment = {**os.environ, "GIT_OPTIONAL_LOCKS": "0"}  # `status` must not write into the checkout
    try:
        done = subprocess.run(
            ["git", "-C", str(folder), *words],
            capture_output=True,
            check=True,
            env=environment,
            stdin=subprocess.DEVNULL,
            text=True,
            timeout=GIT_S,
        )
    except (OSError, subprocess.SubprocessError, UnicodeDecodeError):
        return None
    return done.stdout.strip()
