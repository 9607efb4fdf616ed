"""What a controller says that it plans and was advised, for the operators' scene and the log: it commands nothing."""

from collections.abc import Callable
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from simconsole.bridge.console.command_decoder import CommandTopic
from simconsole.bridge.console.published_tick import MAP_FRAME
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import RemoteProtocolError
from simconsole.values.planned_path import FIELDS, MOST_PLACES, PlannedPath
from simconsole.values.units import NS_PER_S

PLAN: Final = "/autopilot/plan"
PLAN_TYPE: Final = "nav_msgs/Path"
MOST_HZ: Final = 20
"""Newer ones that come faster are passed over."""

ADVICE: Final = "/autopilot/advice"
ADVICE_TYPE: Final = "std_msgs/String"

OnPlan = Callable[[PlannedPath], None]
OnAdvice = Callable[[str], None]
"""Takes an advice as JSON; raises ValueError where it is none."""


class PlanInput:
    """Takes plans in `map`, each at the simulated time at which it comes: its sender may have another clock."""

    def __init__(self, profile: BridgeProfile, on_plan: OnPlan | None) -> None:
        """Hand them to `on_plan`."""
        self._frames = ("", MAP_FRAME, profile.odometry_frame)
        self._on_plan = on_plan
        self._newest_ns = -NS_PER_S
        self.now_ns = 0
        """Simulated time."""

    def topic(self) -> CommandTopic:
        """Return the row of the table of command topics: nobody who plans needs the lease for it."""
        return CommandTopic(PLAN, PLAN_TYPE, self._accept, leased=False)

    def _accept(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        frame = message.header.frame_id.removeprefix("/")
        if frame not in self._frames:
            raise RemoteProtocolError(f"{frame[:64]!r} is not map - at `$.header.frame_id`")
        places = _places(message)
        if not np.isfinite(places).all():
            raise RemoteProtocolError("not finite - at `$.poses`")
        if self._on_plan is None or self._newest_ns <= self.now_ns < self._newest_ns + NS_PER_S // MOST_HZ:
            return
        self._newest_ns = self.now_ns
        self._on_plan(PlannedPath(self.now_ns, places))


class AdviceInput:
    """Takes the speed advice that a controller goes by."""

    def __init__(self, on_advice: OnAdvice | None) -> None:
        """Hand it to `on_advice`."""
        self._on_advice = on_advice

    def topic(self) -> CommandTopic:
        """Return the row of the table of command topics: nobody needs the lease for it."""
        return CommandTopic(ADVICE, ADVICE_TYPE, self._accept, leased=False)

    def _accept(self, plain: dict[str, Any] | None, message: Any, now_ns: int) -> None:
        if self._on_advice is None:
            return
        try:
            self._on_advice(message.data)
        except ValueError as problem:
            raise RemoteProtocolError(f"{ascii(str(problem))[1:65]} - at `$.data`") from None


def _places(message: Any) -> NDArray[np.float64]:
    """Return [N, FIELDS] of a nav_msgs/Path, the first and last place of a long one and some between them."""
    poses, made_ns = message.poses, _ns(message.header.stamp)
    if len(poses) > MOST_PLACES:
        poses = [poses[round(index)] for index in np.linspace(0, len(poses) - 1, MOST_PLACES).tolist()]
    rows = [
        (max(0, _ns(pose.header.stamp) - made_ns) / NS_PER_S, at.x, at.y, at.z)
        for pose in poses
        for at in (pose.pose.position,)
    ]
    return np.array(rows, np.float64).reshape(-1, FIELDS)


def _ns(stamp: Any) -> int:
    return int(stamp.sec) * NS_PER_S + int(stamp.nanosec)
