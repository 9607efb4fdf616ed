"""A session from Python: load it, change values, run it headless, with own code in it."""

import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from functools import cached_property
from pathlib import Path
from threading import current_thread, main_thread
from typing import Final
from weakref import finalize

import msgspec

from simconsole.cli.api.recorded_drive import Drive
from simconsole.drivers.own_controller import Controller, Observer, OwnCode
from simconsole.evaluation.checks.scenario_check import Verdict, check_scenario
from simconsole.profiles.session import SessionProfile
from simconsole.recording.bundles.provenance import Given
from simconsole.session import lifecycle
from simconsole.session.resolution import (
    headless,
    load_session,
    override,
    parted,
    resolve,
    with_named_values,
    with_session_values,
)
from simconsole.tick.assembly import ResolvedSession
from simconsole.values.errors import ProfileError, RecordingError, SimConsoleError
from simconsole.values.own_signals import OwnSignals
from simconsole.values.state_vector import Snapshot
from simconsole.world.kinds.worlds import open_world
from simconsole.world.route import Route

_VALUES: Final = "values"
LONGEST_S: Final = 3600.0
"""Simulated time after which a drive ends that nothing else has ended: its log would fill the disk."""


class Session:
    """A session that can be run any number of times; changing a value makes another one.

    Attributes:
        profile: the session's own profile.
    """

    def __init__(self, profile: SessionProfile, named: Mapping[str, object] | None = None) -> None:
        """Take a profile, and values (dotted keys) in the profiles that it names; `load` reads one from a file."""
        self.profile = profile
        self._named = dict(named or {})

    @cached_property
    def resolved(self) -> ResolvedSession:
        """The session with every profile that it names in full, as its bundle will hold it.

        Raises:
            ProfileError: one of them is missing or wrong.
        """
        return with_named_values(resolve(self.profile), self._named, _VALUES)

    @property
    def route(self) -> Route:
        """The route of its world, which a controller may follow.

        Raises:
            ProfileError: it has no world.
        """
        if self.resolved.world is None:
            raise ProfileError("environment.world: the session has none, so there is no route")
        return open_world(self.resolved.world).route

    def with_values(self, values: Mapping[str, object]) -> "Session":
        """Return the session with other values.

        Args:
            values: by dotted key, as in the files: `environment.friction`, `mode.tick_hz`. Keys of the vehicle need no
                prefix (`body.mass_kg`), those of cockpit and world begin with `cockpit.` and `world.`.

        Raises:
            ProfileError: no such key, or a value out of its bounds: names key, value and range.
        """
        of_session, of_named = parted(values)
        session = Session(with_session_values(self.profile, of_session, _VALUES), {**self._named, **of_named})
        if of_named:
            _ = session.resolved  # a wrong value is told here and not in the run
        return session

    def run(
        self,
        controller: Controller | None = None,
        *,
        observer: Observer | None = None,
        signals: OwnSignals | None = None,
        until: Callable[[Snapshot], bool] | None = None,
        duration_s: float | None = None,
        asks: bool = True,
        out: str | Path | None = None,
        participant: str = "",
        trial: str = "",
        notes: Sequence[str] = (),
    ) -> Drive:
        """Drive the session headless, as `simconsole drive --headless` does, and return the drive.

        Own code is called once per control period (`mode.control_period_ms`), in this process, with the snapshot of the
        tick that ends it. What it raises ends the drive in order and is raised here, once the bundle is complete.

        Args:
            controller: takes the snapshot and returns a command, or None to say nothing; it takes the place of the
                session's autopilot, bag or bridge. Without one the session's own commander drives.
            observer: takes the snapshot, commands nothing.
            signals: own signals, recorded beside ours whenever they were set.
            until: takes the snapshot; the drive ends once it returns true.
            duration_s: longest simulated time; by default the session's own, or an hour.
            asks: whether autonomy is requested for the controller while the vehicle is parked at the beginning.
            out: the bundle's folder, new or empty; by default a temporary one that goes with the returned drive.
            participant: who drives, kept in the bundle.
            trial: which of their drives, kept in the bundle.
            notes: kept in the bundle.

        Raises:
            SimConsoleError: the session cannot be opened, or the disk took no more.
            KeyboardInterrupt: somebody interrupted it; its bundle is complete.
        """
        if current_thread() is not main_thread():
            raise SimConsoleError("run: only in the main thread, which gets the signals that end a drive in order")
        code = OwnCode(controller=controller, observer=observer, signals=signals, until=until, asks=asks)
        if signals is not None:
            signals.forget()
        given = Given(participant=participant, trial=trial, notes=(*_named_in_notes(controller), *notes)).checked()
        folder = Path(tempfile.mkdtemp(prefix="simconsole-") if out is None else out)
        with ExitStack() as stack:
            if out is None:
                stack.callback(shutil.rmtree, folder, ignore_errors=True)
            result = lifecycle.drive(self._to_run(controller, duration_s), folder, given=given, own=code)
            _raise_what_ended(result)
            drive = Drive(folder)
            stack.pop_all()
        if out is None:
            finalize(drive, shutil.rmtree, folder, ignore_errors=True)
        return drive

    def _to_run(self, controller: Controller | None, duration_s: float | None) -> ResolvedSession:
        session = headless(self.resolved.session)
        longest_s = duration_s or session.scenario.duration_s or LONGEST_S
        session = override(session, scenario={"duration_s": longest_s})
        if controller is not None:
            own: dict[str, object] = {"autopilot": None, "commands": None, "controller": None, "commander": "ros"}
            session = override(session, features=own, mode={"pacing": "lockstep"})
        return msgspec.structs.replace(self.resolved, session=session)


def load(name_or_path: str | Path) -> Session:
    """Return the session of that name (`demo`) or file.

    Raises:
        ProfileError: missing or wrong; names file, key, value and allowed range.
    """
    return Session(load_session(str(name_or_path)))


def check(scenario: str | Path) -> Verdict:
    """Drive a scenario (a name or a file) against its bounds, its golden or its limits, as `simconsole check` does.

    Raises:
        ProfileError: scenario or golden cannot be read.
    """
    return check_scenario(str(scenario))


def _named_in_notes(controller: Controller | None) -> tuple[str, ...]:
    """Return what a bundle says of who drove."""
    if controller is None:
        return ()
    kind = controller if hasattr(controller, "__qualname__") else type(controller)
    return (f"own controller {kind.__module__}.{kind.__qualname__}",)


def _raise_what_ended(result: lifecycle.DriveResult) -> None:
    """Raise what has ended a drive before its end."""
    if result.failure is not None:
        result.failure.add_note(f"raised after tick {result.ticks} of the drive in {result.folder}")
        raise result.failure
    if result.interrupted:
        raise KeyboardInterrupt
    if result.recording_failure is not None:
        raise RecordingError(result.recording_failure)
