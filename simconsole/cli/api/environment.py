"""Environments of gymnasium (extra `gymnasium`): a learner in the controller's place, one step per answer.

An action is a command as over the bridge: it passes arbitration and the last gate like any other. A step is as many
ticks as lie between two answers, made at once.
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import Any, Final, SupportsFloat

import msgspec
import numpy as np
from numpy.typing import NDArray

from simconsole.cli.api.session import Session, load
from simconsole.profiles.session import Start
from simconsole.tick.advance import Console
from simconsole.tick.assembly import ResolvedSession, assemble
from simconsole.tick.learner_step import learner_step
from simconsole.values.errors import ProfileError
from simconsole.values.host.jit import compiled, plain
from simconsole.values.kernels import Row
from simconsole.values.signals import NO_AHEAD, NO_COMMAND, NO_EVENTS, NO_SAMPLE, Event, RemoteKind
from simconsole.values.state_vector import INPUT_WIDTH, LAYOUT, Snapshot, TickInputs, input_vector
from simconsole.values.units import DEG_PER_RAD
from simconsole.world.lane_view import MOST, LaneView, path_of, place_at

try:
    import gymnasium
    from gymnasium.vector import AsyncVectorEnv
except ImportError:
    raise ImportError("this needs gymnasium: pip install 'simconsole[gymnasium]'") from None

Observation = NDArray[np.float32]
Action = NDArray[np.float32]

START_LATERAL_M: Final = 0.4
START_HEADING_RAD: Final = 0.03
"""How far off the path an episode begins, at most, on either side."""
LEFT_LANE: Final = -10.0
"""Reward of the step in which the lane was left."""

_AGE: Final = LAYOUT.ros.at("age_ticks")
_EVENTS: Final = LAYOUT.events.at("events")
_ENGAGE_STEPS: Final = 50


class DrivingEnvironment(gymnasium.Env[Observation, Action]):
    """Hold the lane of a session's route.

    Observation: float32 [8], the fields of `LaneView` in their order, in SI units, bounded by MOST.

    Action: float32 in [-1, 1]. The first is the road-wheel angle, a share of `most_road_wheel_rad`, left-positive. The
    second is the acceleration, a share of 2 m/s2 forwards and of 4 m/s2 in braking; with `speed_mps` there is no second
    one, and the console holds that speed.

    Reward of a step: the distance along the path in m, less that share of it by which base_link is off the path, of
    half the lane's width; LEFT_LANE where the lane was left. An episode terminates there, or where the console has
    ended autonomy (a command too hard to be meant), and is truncated after `longest_s`.

    It starts at a place of the route that is drawn from the seed, standing, a little off the path, engaged.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012  gymnasium's own declaration

    def __init__(
        self,
        session: Session | str = "bridge",
        *,
        speed_mps: float | None = None,
        step_ms: int = 100,
        longest_s: float = 60.0,
        half_lane_m: float = 1.75,
        most_road_wheel_rad: float = 0.4,
    ) -> None:
        """Open the session; nothing of it is recorded.

        Args:
            session: or its name; its world must have a route.
            speed_mps: what the console holds; None: the second action is the acceleration.
            step_ms: simulated time of a step, a whole number of ticks, at most 200 (older commands count as stale).
            longest_s: simulated time after which an episode is truncated.
            half_lane_m: how far off the path base_link has left the lane.
            most_road_wheel_rad: road-wheel angle of the action 1.

        Raises:
            ProfileError: no route, traffic or faults (which the environment has not), or a step that is no whole ticks.
        """
        chosen = load(session) if isinstance(session, str) else session
        self._resolved = _for_learning(chosen.resolved)
        self._route = chosen.route
        self._path = path_of(self._route)
        tick_hz = self._resolved.session.mode.tick_hz
        self._ticks = step_ms * tick_hz // 1000
        if step_ms * tick_hz % 1000 or not 1 <= self._ticks <= tick_hz // 5:
            raise ProfileError(f"step_ms: value {step_ms}: a whole number of ticks of {1000 / tick_hz:g} ms, up to 200")
        self._speed_mps, self._half_lane_m = speed_mps, half_lane_m
        self._most_rad = most_road_wheel_rad
        self._most_steps = round(longest_s * 1000.0 / step_ms)
        bounds = np.array(MOST, np.float32)
        self.observation_space = gymnasium.spaces.Box(-bounds, bounds, dtype=np.float32)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (1 if speed_mps is not None else 2,), np.float32)
        self._blank = np.zeros(len(LaneView._fields), np.float32)
        self._console: Console | None = None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin an episode; equal seeds begin equal ones. `options` may name the place: `{"s_m": 120.0}`."""
        super().reset(seed=seed)
        drawn = self.np_random.uniform(-1.0, 1.0, 3)
        s_m = 0.5 * (1.0 + drawn[0]) * self._route.length_m
        if options is not None and "s_m" in options:
            s_m = float(options["s_m"])
        there = assemble(self._started(s_m, drawn[1:]), plain)[0]  # nothing is compiled or run by it
        if self._console is None:
            self._console = self._compiled()
        self._console.initial[:] = self._rows[0] = there.initial
        self._rows[1:, :INPUT_WIDTH] = _quiet(self._ticks)
        self._place[:] = place_at(self._path, s_m)
        self._steps = 0
        return self._engaged(), {"s_m": float(self._place[2])}

    def _compiled(self) -> Console:
        """Return the console, and make ready what its steps hold: it is written anew at each reset."""
        console = assemble(self._resolved, compiled)[0]
        self._rows, self._place = np.zeros((1 + self._ticks, console.width)), place_at(self._path, 0.0)
        kind = RemoteKind.ACCELERATION if self._speed_mps is None else RemoteKind.SPEED
        self._advance = learner_step(console, self._rows, kind, self._path, self._place, compiled)
        return console

    def _started(self, s_m: float, off: NDArray[np.float64]) -> ResolvedSession:
        """Return the session that starts `s_m` along the route, off it by shares of the most."""
        at, lateral_m = self._route.at(s_m), START_LATERAL_M * float(off[0])
        yaw_rad = math.remainder(at.yaw_rad + START_HEADING_RAD * float(off[1]), math.tau)
        start = Start(
            x_m=at.x_m - lateral_m * math.sin(at.yaw_rad),
            y_m=at.y_m + lateral_m * math.cos(at.yaw_rad),
            yaw_deg=yaw_rad * DEG_PER_RAD,
        )
        session = self._resolved.session
        scenario = msgspec.structs.replace(session.scenario, start=start)
        return msgspec.structs.replace(self._resolved, session=msgspec.structs.replace(session, scenario=scenario))

    def _engaged(self) -> Observation:
        """Command standstill until autonomy is granted; return what is seen then.

        Raises:
            ProfileError: it never is.
        """
        seen = self._blank.copy()
        self._rows[1, _EVENTS] = Event.REQUEST_AUTONOMOUS
        for _ in range(_ENGAGE_STEPS):
            if self._advance(0.0, 0.0, seen):
                self._rows[1, _EVENTS] = 0.0
                return seen
        raise ProfileError("features.control: autonomy is not granted: person_required: false, and nobody in the seat")

    def step(self, action: Action) -> tuple[Observation, SupportsFloat, bool, bool, dict[str, Any]]:
        """Command, and make the ticks of a step."""
        if (asked := self._speed_mps) is None:
            share = min(max(action.item(1), -1.0), 1.0)
            asked = share * (2.0 if share > 0.0 else 4.0)
        before_m, seen = self._place.item(2), self._blank.copy()
        driving = self._advance(min(max(action.item(0), -1.0), 1.0) * self._most_rad, asked, seen)
        self._steps += 1
        off = abs(self._place.item(3)) / self._half_lane_m
        ended = off > 1.0 or not driving
        reward = LEFT_LANE if ended else (self._place.item(2) - before_m) * (1.0 - off)
        return seen, reward, ended, self._steps >= self._most_steps, {}

    @property
    def snapshot(self) -> Snapshot:
        """The tick that the last step has ended with."""
        return Snapshot(self._steps * self._ticks, self._resolved.session.mode.tick_hz, self._rows[0].copy())


def vector_environment(count: int, session: Session | str = "bridge", **options: Any) -> AsyncVectorEnv:
    """Return `count` environments, each in a process of its own; `options` as of DrivingEnvironment.

    A program that calls this must protect its beginning by `if __name__ == "__main__":`, for each process reads it.
    """
    made: Sequence[Any] = [partial(DrivingEnvironment, session, **options)] * count
    return AsyncVectorEnv(made, context="spawn")


def _for_learning(resolved: ResolvedSession) -> ResolvedSession:
    session = resolved.session
    if session.environment.traffic is not None or session.scenario.faults:
        raise ProfileError("environment.traffic, scenario.faults: an environment of gymnasium has none")
    features = msgspec.structs.replace(session.features, autopilot=None, commands=None, commander="ros")
    return msgspec.structs.replace(resolved, session=msgspec.structs.replace(session, features=features))


def _quiet(ticks: int) -> Row:
    """Return the inputs of ticks in which nobody is in the seat and a command grows older."""
    inputs = np.tile(input_vector(TickInputs(NO_SAMPLE, NO_COMMAND, NO_EVENTS, ahead=NO_AHEAD)), (ticks, 1))
    inputs[:, _AGE] = np.arange(ticks)
    return inputs
