"""A headless drive's outputs: the bridge on the core's own sockets in lockstep, and programs beside it."""

import os
import subprocess
import sys
from typing import Any, Protocol

from simconsole.ledger import Hop
from simconsole.profiles.bridge import BridgeProfile
from simconsole.rows import Snapshot
from simconsole.signals import Event, EventInput, RemoteCommand

PROGRAM_END_S = 5.0
STAND_S = 0.02
TOKEN_VARIABLE = "SIMCONSOLE_TOKEN"
"""The environment's variable with the token that the commands show which connect to a server."""


class LockstepServer(Protocol):
    """What this module needs of bridge.lockstep."""

    def exchange(self, snapshot: Snapshot, timeout_s: float) -> bool:
        """Publish, then wait for the command that answers this very snapshot."""

    def publish(self, snapshot: Snapshot) -> None:
        """Publish what is due, without waiting."""

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command and the events."""

    def stand(self, timeout_s: float) -> None:
        """Serve for a moment without publishing anything."""

    def counts(self) -> dict[str, int]:
        """Return how many messages went to and from all clients."""

    @property
    def clients(self) -> int:
        """Connected clients."""

    def acts(self) -> list[dict[str, Any]]:
        """What operators have done."""


class LockstepLink:
    """The bridge as the drive loop sees it: waits for the controller once per control period, never in between.

    After a missing answer (an event in the log) it does not wait again until the controller has spoken: the command
    grows stale in simulated time and the arbiter stops the car.
    """

    hop = Hop.EXCHANGE

    def __init__(self, bridge: LockstepServer, period_ticks: int, timeout_s: float) -> None:
        self._bridge = bridge
        self._period_ticks = period_ticks
        self._timeout_s = timeout_s
        self._silent_at: float | None = None  # the command's sequence number when the controller went silent
        self._sequence = 0.0
        self._raised = 0
        self.exchanges = 0
        self.unanswered = 0

    def publish(self, snapshot: Snapshot) -> None:
        """Publish; at the end of a control period, wait for the answer."""
        if snapshot.tick % self._period_ticks:
            return  # sockets are served at fixed ticks only, or the drive would depend on when bytes arrive
        silent = self._silent_at is not None and self._silent_at == self._sequence
        if silent or not self._bridge.clients:
            self._bridge.publish(snapshot)
            return
        self._silent_at = None
        self.exchanges += 1
        if not self._bridge.exchange(snapshot, self._timeout_s):
            self.unanswered += 1
            self._silent_at = self._sequence
            self._raised = int(Event.NO_ANSWER)

    def stand(self, snapshot: Snapshot) -> None:
        """Serve the clients while simulated time stands."""
        self._bridge.stand(STAND_S)

    def acts(self) -> list[dict[str, Any]]:
        """Return what operators have done, as plain values."""
        return self._bridge.acts()

    def counters(self) -> dict[str, Any]:
        """Return how often the drive waited for the controller, how often in vain, and what the bridge counted."""
        return {"exchanges": self.exchanges, "unanswered": self.unanswered, "bridge": self._bridge.counts()}

    def take(self, tick: int) -> tuple[RemoteCommand, EventInput]:
        """Return the newest command, its age in ticks, and the edges, a missing answer among them."""
        remote, events = self._bridge.take(tick)
        self._sequence = remote.sequence
        raised, self._raised = self._raised, 0
        return remote, EventInput(events=float(int(events.events) | raised))


def start_autopilot(
    url: str, course: str, bridge: BridgeProfile, token: str | None = None
) -> "subprocess.Popen[bytes]":
    """Start `simconsole autopilot` as a program of its own; `end_program` ends it.

    Args:
        url: the console's own server.
        course: what to follow.
        bridge: what its topics are called, and its certificate.
        token: what the server asks for; it goes by the environment, for everyone can read a program's arguments.
    """
    words = [sys.executable, "-m", "simconsole", "autopilot", "--url", _here(url), "--course", course]
    if bridge.namespace:
        words += ["--namespace", bridge.namespace]
    for standard, name in bridge.rename.items():
        words += ["--rename", f"{standard}={name}"]
    if bridge.certificate is not None:
        words += ["--certificate", bridge.certificate]
    environment = dict(os.environ) if token is None else {**os.environ, TOKEN_VARIABLE: token}
    # A group of its own: a terminal's Ctrl-C reaches the core only, which then ends the drive in order.
    return subprocess.Popen(
        words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, process_group=0, env=environment
    )


def _here(url: str) -> str:
    """Return the address for this machine of a server that listens on all addresses: no certificate names those."""
    return url.replace("//0.0.0.0:", "//127.0.0.1:").replace("//[::]:", "//[::1]:")


def end_program(program: "subprocess.Popen[bytes]") -> None:
    """Give a program that has lost its connection the time to end by itself, then end it."""
    try:
        program.wait(PROGRAM_END_S)
    except subprocess.TimeoutExpired:
        program.kill()
        program.wait()
