"""A lab's own controller as a plain function, in the place of a program behind the bridge: no socket, no process.

It stands where the bridge stands in lockstep: asked once per control period with the tick's snapshot, answered by the
command that the arbiter sees from the next tick on. So link, watchdog, gate and log treat it like any other.
"""

import math
from collections.abc import Callable
from typing import Final, NamedTuple, TypeVar

from simconsole.bridge.console.input_slots import BridgeInputs
from simconsole.values.own_signals import OwnSignals
from simconsole.values.signals import Event, EventInput, LinkState, Mode, RemoteCommand
from simconsole.values.state_vector import Snapshot

T = TypeVar("T")

Controller = Callable[[Snapshot], RemoteCommand | None]
"""Sees a tick and returns the command that answers it; None: it says nothing, and its last command grows old."""
Observer = Callable[[Snapshot], object]
"""Sees a tick; what it returns is not looked at."""


class OwnCode(NamedTuple):
    """What a lab's own Python does in a drive, each where there is any. All of it is called once per control period."""

    controller: Controller | None = None
    observer: Observer | None = None
    signals: OwnSignals | None = None
    until: Callable[[Snapshot], bool] | None = None  # true: the drive is over
    asks: bool = True  # for autonomy, while the vehicle is parked at the beginning


NO_OWN_CODE: Final = OwnCode()


class FunctionController:
    """Calls a controller as the bridge in lockstep would ask one, and keeps its commands likewise."""

    clients = 1

    def __init__(self, controller: Controller, asks: bool = True) -> None:
        """Ask `controller`; where it `asks`, request autonomy for it while the vehicle is parked at the beginning."""
        self._controller = controller
        self._asks = asks
        self._inputs = BridgeInputs()

    def exchange(self, snapshot: Snapshot, timeout_s: float, stop: Callable[[], bool]) -> bool:
        """Ask for the command that answers this snapshot. Whoever says nothing has answered all the same."""
        self._inputs.tick = snapshot.tick
        self._hear(self._controller(snapshot))
        if snapshot.arbitration.mode != Mode.PARKED:
            self._asks = False
        elif self._asks and snapshot.ros_link.state == LinkState.STEADY:
            self._inputs.raise_events(int(Event.REQUEST_AUTONOMOUS))
        return True

    def _hear(self, command: RemoteCommand | None) -> None:
        if command is None:
            return
        if not all(map(math.isfinite, command)):
            self._inputs.refuse()
            return
        self._inputs.keep(turn_indicators=command.turn_indicators, hazard_lights=command.hazard_lights)
        self._inputs.accept(command, None, 0)

    def publish(self, snapshot: Snapshot) -> None:
        """Show it a tick that nobody waits for an answer to: there is none."""

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command, its age in ticks since it was given, and what it asks for."""
        return self._inputs.take(tick)

    def stand(self, timeout_s: float) -> None:
        """Do nothing while simulated time stands."""

    def counts(self) -> dict[str, int]:
        """Return how many commands it has given, and how many of them were refused."""
        command = self._inputs.command
        return {"own_commands": int(command.sequence), "own_refused": int(command.refused)}

    def take_acts(self) -> list[bytes]:
        """Return that it does no operator's acts."""
        return []


class FunctionObserver:
    """Calls an observer once per control period."""

    def __init__(self, observer: Observer, period_ticks: int) -> None:
        self._observer = observer
        self._period_ticks = period_ticks

    def publish(self, snapshot: Snapshot) -> None:
        """Show it the tick, at the end of a control period."""
        if snapshot.tick % self._period_ticks == 0:
            self._observer(snapshot)

    def unseen(self, tick: int) -> int:
        """Return how many ticks, from `tick` on, do not end a control period."""
        return -tick % self._period_ticks


class OwnParts:
    """The parts of one drive that call a lab's own code.

    What it raises ends the drive in order: the bundle is finished first, then `failure` is raised where the drive was
    started. Nothing of its code is called after that.

    Attributes:
        controller: in the place of the bridge; None where there is none.
        observer: an output; None where there is none.
        failure: what the code has raised.
    """

    def __init__(self, code: OwnCode, period_ticks: int) -> None:
        self._until = code.until
        self.controller: FunctionController | None = None
        self.observer: FunctionObserver | None = None
        self.failure: BaseException | None = None
        if code.controller is not None:
            self.controller = FunctionController(self._kept(code.controller), code.asks)
        if code.observer is not None:
            self.observer = FunctionObserver(self._kept(code.observer), period_ticks)

    def _kept(self, called: Callable[[Snapshot], T]) -> Callable[[Snapshot], T | None]:
        def call(snapshot: Snapshot) -> T | None:
            if self.failure is None:
                try:
                    return called(snapshot)
                except BaseException as error:  # noqa: BLE001  raised again once the drive is closed
                    self.failure = error
            return None

        return call

    def ended(self, snapshot: Snapshot) -> bool:
        """Return whether the drive is over, because the code has failed or says so."""
        over = self._until is not None and bool(self._kept(self._until)(snapshot))
        return over or self.failure is not None
