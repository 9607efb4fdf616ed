"""One commander at a time: the lease starts with the first valid command and ends a while after the last."""

from collections.abc import Callable


class Lease:
    """Who commands the console. Clients are numbers; time is given, in ns."""

    def __init__(self, length_ns: int) -> None:
        """A lease ends `length_ns` after its holder's last valid command."""
        self.length_ns = length_ns
        self._holder: int | None = None
        self._last_ns = 0

    def holder(self, now_ns: int) -> int | None:
        """Return who holds the lease at `now_ns`, None when it is free."""
        if self._holder is not None and now_ns - self._last_ns >= self.length_ns:
            self._holder = None
        return self._holder

    def is_open_to(self, client: int, now_ns: int) -> bool:
        """Return whether `client` may command: it holds the lease, or the lease is free."""
        return self.holder(now_ns) in (None, client)

    def renew(self, client: int, now_ns: int) -> None:
        """Give or prolong the lease after a valid command of `client`."""
        self._holder = client
        self._last_ns = now_ns

    def release(self, client: int, now_ns: int) -> bool:
        """End the lease of a client that is gone; return whether it held one."""
        held = self.holder(now_ns) == client
        if held:
            self._holder = None
        return held


class CommandDesk:
    """Where the commands of one platform arrive: its lease, and who is told of refusals and of a change of commander.

    Attributes:
        lease: of who commands the platform.
        on_refused: called for each refused command of a client that may command.
        on_new_commander: called when a command comes while nobody holds the lease, before it is checked.
        on_lost: called when the client that held the lease is gone.
    """

    def __init__(self, lease_ns: int, on_refused: Callable[[], None] = lambda: None) -> None:
        """Start with nobody in command."""
        self.lease = Lease(lease_ns)
        self.on_refused = on_refused
        self.on_new_commander: Callable[[], None] = lambda: None
        self.on_lost: Callable[[], None] = lambda: None
