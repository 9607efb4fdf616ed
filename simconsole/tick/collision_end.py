"""The end of a drive whose vehicle has struck something, where what that does to it is not modelled."""

from typing import Any, Final

from simconsole.values.platform import Platform
from simconsole.values.protocols import Output
from simconsole.values.state_vector import LAYOUT, Snapshot

_COLLISION_AT: Final = LAYOUT.rules.at("collision")
_NEVER_LOOKS: Final = 2**53


class CollisionEnd:
    """Notices the first collision of a vehicle that takes no impulse: an output of the drive loop.

    The tick of a collision is the last of those that are made at once, so it needs to see no other.
    """

    def __init__(self, platform: Platform) -> None:
        self._name, self._reason = platform.name, ""
        self.outputs: tuple[Output, ...] = (self,) if platform.solid is None else ()
        """It, for the loop, where it has anything to notice."""

    def publish(self, snapshot: Snapshot) -> None:
        """See one tick."""
        if snapshot.vector[_COLLISION_AT] and not self._reason:
            self._reason = f"collision at tick {snapshot.tick}: a {self._name} cannot be pushed"

    def unseen(self, tick: int) -> int:
        """Return how many ticks, from `tick` on, it need not see."""
        return _NEVER_LOOKS

    def ended(self) -> bool:
        """Return whether the drive cannot go on."""
        return bool(self._reason)

    def summary(self) -> dict[str, Any]:
        """Return why the drive has ended, if it has for this."""
        return {"ended": self._reason} if self._reason else {}
