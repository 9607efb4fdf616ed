"""The interface of a fault's switch to the layers: whether it is on, and for how long."""

from typing import Protocol


class Switched(Protocol):
    """A switch that tells for how many ticks it has been on."""

    @property
    def ticks(self) -> int:
        """For how many ticks it has been on, the coming one included; 0 while it is off."""
