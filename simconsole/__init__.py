"""A hardware-in-the-loop driving-simulator console, and its Python API (docs/python.md). Start at docs/tick.md.

What the API offers is loaded when it is first asked for.
"""

TYPE_CHECKING = False  # type checkers take this name for true; typing need not be loaded for it
if TYPE_CHECKING:
    from simconsole.cli.api.commands import Command as Command
    from simconsole.cli.api.commands import accelerate as accelerate
    from simconsole.cli.api.commands import actuate as actuate
    from simconsole.cli.api.commands import go_to as go_to
    from simconsole.cli.api.commands import hold_speed as hold_speed
    from simconsole.cli.api.commands import twist as twist
    from simconsole.cli.api.environment import DrivingEnvironment as DrivingEnvironment
    from simconsole.cli.api.environment import vector_environment as vector_environment
    from simconsole.cli.api.recorded_drive import Drive as Drive
    from simconsole.cli.api.recorded_drive import DriveEvent as DriveEvent
    from simconsole.cli.api.recorded_drive import open_drive as open_drive
    from simconsole.cli.api.session import Session as Session
    from simconsole.cli.api.session import check as check
    from simconsole.cli.api.session import load as load
    from simconsole.values.errors import SimConsoleError as SimConsoleError
    from simconsole.values.own_signals import OwnSignals as OwnSignals
    from simconsole.values.signals import Mode as Mode
    from simconsole.values.state_vector import Snapshot as Snapshot
    from simconsole.values.version import __version__ as __version__

_OFFERED = {
    "Command": "cli.api.commands",
    "accelerate": "cli.api.commands",
    "actuate": "cli.api.commands",
    "go_to": "cli.api.commands",
    "hold_speed": "cli.api.commands",
    "twist": "cli.api.commands",
    "Drive": "cli.api.recorded_drive",
    "DriveEvent": "cli.api.recorded_drive",
    "open_drive": "cli.api.recorded_drive",
    "DrivingEnvironment": "cli.api.environment",
    "vector_environment": "cli.api.environment",
    "Session": "cli.api.session",
    "check": "cli.api.session",
    "load": "cli.api.session",
    "SimConsoleError": "values.errors",
    "OwnSignals": "values.own_signals",
    "Mode": "values.signals",
    "Snapshot": "values.state_vector",
    "__version__": "values.version",
}
"""Where each name of the API stands."""

__all__ = [*_OFFERED]


def __getattr__(name: str) -> object:
    """Load what was asked for."""
    if name not in _OFFERED:
        raise AttributeError(f"module 'simconsole' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"simconsole.{_OFFERED[name]}"), name)


def __dir__() -> list[str]:
    """Return what there is, loaded or not."""
    return sorted(__all__)
