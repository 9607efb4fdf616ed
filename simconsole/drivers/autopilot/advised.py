"""The autopilot and speed advice: the speed with which it comes to the next light at green. Pure."""

from typing import Final

from simconsole.drivers.path_tracker.signal_stops import GAP_M, Approach
from simconsole.drivers.path_tracker.speed_profile import SpeedProfile
from simconsole.world.rules.speed_advice import LEAST_MPS, NO_ADVICE, Advice, SpeedAdvisor, rolling_mps
from simconsole.world.rules.speed_advice import Advised as Kind

REACTION_S: Final = 0.5
"""Jerk and the answer of the car."""
SPARE_S: Final = 4.0
"""It brakes for a light that is red still, from where it can do so gently: green must have come before that."""
LEAST_AHEAD_M: Final = 1.0


class Advised:
    """Follows advice along the planned speeds, which are the limit."""

    def __init__(self) -> None:
        """Begin without advice."""
        self._advisor = SpeedAdvisor(REACTION_S, SPARE_S)
        self.advice: Advice = NO_ADVICE

    def target_mps(
        self, approach: Approach | None, s_m: float, speed_mps: float, plan: SpeedProfile, now_s: float
    ) -> float | None:
        """Return the speed that is advised until the line, or to roll with towards a stop; None: neither is."""
        if approach is None or approach.left_m < LEAST_AHEAD_M:
            self._forget()
            return None
        first, last = (round(place / plan.step_m) for place in (s_m, approach.line_m))
        planned = plan.speed_mps[max(first, 0) : max(last, first + 1)]
        limit_mps = float(planned.min()) if len(planned) else 0.0
        if limit_mps < LEAST_MPS:  # a tight bend on the way: nobody creeps along all of it for that
            self._forget()
            return None
        self.advice = self._advisor.advise(
            approach.left_m, speed_mps, limit_mps, approach.greens, now_s, line=approach.line_m
        )
        if self.advice.kind is Kind.STOP:
            return rolling_mps(approach.left_m - GAP_M)
        return self.advice.target_mps if self.advice.kind is Kind.SPEED else None

    def _forget(self) -> None:
        self._advisor.reset()
        self.advice = NO_ADVICE
