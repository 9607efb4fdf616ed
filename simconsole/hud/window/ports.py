"""What a driver's window needs of the world outside, and what its loop needs of it."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

from simconsole.hud.aids import NO_AIDS, Aids
from simconsole.values.state_vector import Snapshot
from simconsole.world.rules.speed_advice import NO_ADVICE, Advice
from simconsole.world.traffic.road_users import RoadUsersAt


class Motion(NamedTuple):
    """The two newest ticks, and how long ago the newer one was published."""

    older: Snapshot
    newer: Snapshot
    age_s: float
    road_users: RoadUsersAt | None = None  # of the newest step of traffic; None: there is none
    road_users_before: RoadUsersAt | None = None  # of the step before


class Ports(NamedTuple):
    """What the window needs of the world outside."""

    latest: Callable[[], Snapshot | None]  # the newest tick, None before the first
    report_keys: Callable[[int], None]  # takes a `Key` mask at every frame: its silence means the keyboard is gone
    stop: Callable[[], bool]  # True ends the window
    can_up: Callable[[], bool | None] = lambda: None  # whether the CAN bus is up; None where there is none
    drawn: Callable[[], None] = lambda: None  # told after every frame
    link: Callable[[], str | None] = lambda: None  # how the rosbridge link stands; None where there is no bridge
    advice: Callable[[], Advice] = lambda: NO_ADVICE  # for the next traffic light
    motion: Callable[[], Motion | None] = lambda: None  # for a picture that moves between two ticks


class DriverWindow(Protocol):
    """A window in front of the driver."""

    drawer: str
    """What draws its pixels."""

    def frame(
        self,
        snapshot: Snapshot | None,
        now_s: float,
        can_up: bool | None = None,
        link: str | None = None,
        motion: Motion | None = None,
        aids: Aids = NO_AIDS,
        advice: Advice = NO_ADVICE,
    ) -> None:
        """Draw one frame. `can_up`, `link`: None without CAN bus or bridge."""

    def resized(self, width_px: int, height_px: int) -> None:
        """Draw as large as the window is now."""

    def close(self) -> None:
        """Close the window."""
