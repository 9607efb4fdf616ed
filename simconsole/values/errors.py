"""Everything simconsole raises on purpose.

::

    SimConsoleError
    +-- ProfileError            a profile or script: file, key, value, allowed range
    +-- DeviceError             a cockpit device
    |   +-- DeviceNotFound      the profile names a device that is not there
    |   +-- DeviceModeError     the device is there in a mode that cannot drive
    +-- BridgeError             the rosbridge link
    |   +-- OtherDriveError     the server belongs to another drive than the one that started this program
    |   +-- LocalProtocolError  we broke the protocol: a bug here
    |   +-- RemoteProtocolError the peer broke the protocol: answered with a status
    |       +-- FrameError      below its messages: answered with a close code
    +-- CanError                the CAN bus, a DBC or a frame
    +-- RecordingError          a bundle or log that cannot be read
    +-- VehicleError            a vehicle of another package fails in a drive
    +-- ControllerError         a controller of another package fails in a drive
    +-- MetricError             a metric of another package fails on a drive
    +-- WorkerError            a consumer process or its shared memory

The command line prints the message on one line and exits with `exit_code`; a traceback means a bug.
"""

import difflib
from collections import abc


def near(word: str, known: abc.Sequence[str]) -> str:
    """Return the known word that was probably meant, "" where none is near."""
    return next(iter(difflib.get_close_matches(word, known, n=1)), "")


def did_you_mean(word: str, known: abc.Sequence[str]) -> str:
    """Return what to say of a word that is none of the known ones: which is near, or all."""
    guess = near(word, known)
    return f"did you mean {guess}?" if guess else f"one of {', '.join(known) or 'none'}"


def one_line(error: BaseException) -> str:
    """Return what an error says, on one line; its name where it says nothing or is none of ours."""
    said = " ".join(str(error).split())
    if isinstance(error, SimConsoleError):
        return said
    kind = "out of memory" if isinstance(error, MemoryError) else type(error).__name__
    return f"{kind}: {said}" if said else kind


class SimConsoleError(Exception):
    """Base of all errors a user can cause or cure. The message is one complete line."""

    exit_code = 2


class ProfileError(SimConsoleError):
    """A profile, script or trace cannot be used. Names file, key, value and allowed range."""


class DeviceError(SimConsoleError):
    """A cockpit device cannot be used."""


class DeviceNotFound(DeviceError):
    """A device that the profile binds is not connected."""


class DeviceModeError(DeviceError):
    """A device is connected in a mode that cannot drive (the T500 RS boots as a gamepad)."""


class BridgeError(SimConsoleError):
    """The rosbridge link cannot be opened or has failed."""


class OtherDriveError(BridgeError):
    """The server refuses this program, which another drive has started; trying again would not help."""

    exit_code = 1


class LocalProtocolError(BridgeError):
    """This side asked for something the protocol forbids."""


class RemoteProtocolError(BridgeError):
    """The peer sent something the protocol forbids; nothing of it was applied."""


class FrameError(RemoteProtocolError):
    """The peer broke the WebSocket protocol or a limit of its frames; `code` is the close code that says which."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code


class CanError(SimConsoleError):
    """The CAN bus cannot be opened, a DBC cannot be read, or a frame may not or cannot be sent."""


class RecordingError(SimConsoleError):
    """A bundle or log is missing, truncated before its first tick, altered or of another version."""


class VehicleError(SimConsoleError):
    """A vehicle of another package, an FMU, fails in a drive. Names the file and the simulated time."""


class ControllerError(SimConsoleError):
    """A controller of another package fails in a drive. Names the controller and the tick."""


class MetricError(SimConsoleError):
    """A metric of another package fails on a drive, or returns what it does not promise. Names metric and figure."""


class WorkerError(SimConsoleError):
    """A worker process or the shared memory that feeds it cannot be opened."""
