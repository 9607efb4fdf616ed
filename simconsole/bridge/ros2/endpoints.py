"""One kind of a node's endpoints: made and ended as they are wanted, each fenced off from the others."""

import logging
from collections.abc import Callable, Mapping
from typing import Any, Final

POLL_S: Final = 0.1
"""Period of polling the graph: changes there are seen this much later."""
RETRY_UPDATES: Final = 10
"""Updates between two attempts to make what could not be made."""
REPORTED_ATTEMPTS: Final = 2
"""The attempt that is reported: the first may have met an endpoint that was just about to end."""

_logger: Final = logging.getLogger("simconsole.bridge.ros2.endpoints")


class Endpoints:
    """The endpoints by name, with how they were made. rclpy says of no call what it raises: each is fenced."""

    def __init__(
        self,
        make: Callable[[str, Any], Any],
        end: Callable[[Any], bool | None],
        report: Callable[[str, str], None] = lambda name, why: None,
    ) -> None:
        """Start without any.

        Args:
            make: makes the endpoint of a name as it is wanted; may raise anything.
            end: ends an endpoint; asked again while it returns False, for there is an answer to be given before.
            report: gets the name of what cannot be made and why, and an empty reason once it can.
        """
        self._make = make
        self._end = end
        self._report = report
        self._have: dict[str, tuple[Any, Any]] = {}
        self._ending: dict[str, Any] = {}
        self._failed: dict[str, tuple[Any, int]] = {}

    def __contains__(self, name: str) -> bool:
        """Return whether there is an endpoint of this name, one that is about to end included."""
        return name in self._have or name in self._ending

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self._have) + len(self._ending)

    def find(self, name: str) -> tuple[Any, Any] | None:
        """Return how an endpoint was made and the endpoint, None without one."""
        return self._have.get(name)

    def retire(self, wanted: Mapping[str, Any]) -> None:
        """Begin to end what is no longer wanted so; all kinds do this before any makes a new one."""
        for name in [name for name, (how, _) in self._have.items() if wanted.get(name) != how]:
            self._ending[name] = self._have.pop(name)[1]
        for name, endpoint in list(self._ending.items()):
            try:
                if self._end(endpoint) is False:
                    continue
            except Exception as error:  # noqa: BLE001  rclpy says of no call what it raises
                _logger.warning("%s: cannot be ended: %s", name, error)
            del self._ending[name]
        for name in [name for name, (how, _) in self._failed.items() if wanted.get(name) != how]:
            self._report_success(name)

    def create(self, wanted: Mapping[str, Any]) -> None:
        """Make what is wanted and not there; what cannot be made is tried again now and then."""
        for name, how in wanted.items():
            if name in self._have or name in self._ending:
                continue
            _, attempts = self._failed.get(name, (how, 0))
            if attempts < REPORTED_ATTEMPTS or attempts % RETRY_UPDATES == 0:
                try:
                    self._have[name] = (how, self._make(name, how))
                except Exception as error:  # noqa: BLE001  rclpy says of no call what it raises
                    if attempts + 1 == REPORTED_ATTEMPTS:
                        self._report(name, str(error))
                else:
                    self._report_success(name)
                    continue
            self._failed[name] = (how, attempts + 1)

    def _report_success(self, name: str) -> None:
        _, attempts = self._failed.pop(name, (None, 0))
        if attempts >= REPORTED_ATTEMPTS:
            self._report(name, "")
