"""Goals from outside: by the topic /goal_pose, and by the action /navigate_to_pose, which can be cancelled."""

from typing import Any, Final

from simconsole.bridge.protocol import client_protocol
from simconsole.drivers.robots.navigation.navigator import Goal, Navigator, Progress
from simconsole.drivers.robots.nodes.ros_messages import MAP_FRAME, plain_pose, yaw_of
from simconsole.values.platform import Pose

GOAL: Final = "/goal_pose"
ACTION: Final = "/navigate_to_pose"
ACTION_TYPE: Final = "nav2_msgs/action/NavigateToPose"
FEEDBACK_S: Final = 1.0


class Goals:
    """Hands goals to a navigator, the newest in place of the one before it."""

    def __init__(self, navigator: Navigator, is_open: bool = True) -> None:
        """Begin without a goal; where this is not open none is taken: a mission is under way."""
        self._is_open = is_open
        self._navigator = navigator
        self._goal: client_protocol.Goal | None = None
        self._since_s: float | None = None
        self._told_s = 0.0

    def aim(self, message: Any) -> None:
        """Go where a geometry_msgs/PoseStamped says; one in another frame than map is passed over."""
        if self._is_open and message.header.frame_id in ("", MAP_FRAME):
            self._end("another goal has come")
            self._navigator.aim(
                Goal(message.pose.position.x, message.pose.position.y, yaw_of(message.pose.orientation))
            )

    def pursue(self, goal: client_protocol.Goal) -> None:
        """Take a goal of the action."""
        try:
            stamped = goal.args["pose"]
            frame = stamped.get("header", {}).get("frame_id", "")
            place, turn = stamped["pose"]["position"], stamped["pose"].get("orientation", {})
            x_m, y_m = float(place["x"]), float(place["y"])
            yaw_rad = yaw_of(_Turn(turn))
        except (KeyError, TypeError, ValueError, AttributeError):
            goal.fail("pose: expected a geometry_msgs/PoseStamped")
            return
        if not self._is_open:
            goal.fail("a mission is under way")
        elif frame not in ("", MAP_FRAME):
            goal.fail(f"pose.header.frame_id: value {frame}: {MAP_FRAME}")
        else:
            self._end("another goal has come")
            self._goal, self._since_s = goal, None
            self._navigator.aim(Goal(x_m, y_m, yaw_rad))

    def report(self, time_s: float, pose: Pose) -> None:
        """Tell who has sent the goal of the action how it stands."""
        goal, navigator = self._goal, self._navigator
        if goal is None:
            return
        if self._since_s is None:
            self._since_s = self._told_s = time_s
        if goal.cancelled:
            navigator.aim(None)
            self._end("cancelled")
        elif navigator.progress is Progress.REACHED:
            self._goal = None
            goal.succeed({"error_code": 0, "error_msg": ""})
        elif navigator.progress is not Progress.UNDER_WAY:
            self._end("no way to the goal was found, or none that could be driven")
        elif time_s >= self._told_s + FEEDBACK_S:
            self._told_s = time_s
            goal.tell(self._feedback(time_s - self._since_s, pose))

    def _feedback(self, driven_s: float, pose: Pose) -> dict[str, Any]:
        navigator = self._navigator
        left_m = navigator.left_m if navigator.path_m is not None else 0.0
        return {
            "current_pose": {"header": {"frame_id": MAP_FRAME}, "pose": plain_pose(pose)},
            "navigation_time": {"sec": int(driven_s), "nanosec": int(1e9 * (driven_s % 1.0))},
            "number_of_recoveries": navigator.recoveries,
            "distance_remaining": left_m,
        }

    def _end(self, reason: str) -> None:
        goal, self._goal = self._goal, None
        if goal is not None:
            goal.fail(reason)


class _Turn:
    """A quaternion of plain values; what is missing is 0, and no quaternion at all means no turn."""

    def __init__(self, plain: dict[str, float]) -> None:
        self.x, self.y, self.z = (float(plain.get(name, 0.0)) for name in "xyz")
        self.w = float(plain.get("w", 1.0))
