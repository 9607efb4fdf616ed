"""What every layer asks of a fault's switch: whether it is on, and for how long."""

from typing import Protocol


class Switched(Protocol):
    """Something that is on for a number of ticks."""

    @property
    def ticks(self) -> int:
        """For how many ticks it has been on, the coming one included; 0 while it is off."""
