"""How much authority the controller has over steering while control is shared: fixed, by danger, or by consent.

Fixed: the profile's share. By time to line crossing: more, the sooner the person's steering would leave the lane
(adaptive haptic authority: Zwaan, Petermeijer, Abbink 2019). Traded: less, for as long as the person pushes against the
controller (traded control after the method of tud-hri/joan: a torque threshold and an integrated, smoothed state).
"""

import math
from typing import Final, NamedTuple

from simconsole.control.requests.angles import lateral_apart
from simconsole.control.requests.control_settings import ControlSettings
from simconsole.control.requests.longitudinal import finite_or
from simconsole.control.requests.tick_context import TickContext
from simconsole.values.kernels import clip, kernel
from simconsole.values.signals import VehicleState

BY_LINE_CROSSING: Final = 1.0
TRADED: Final = 2.0
NEVER_S: Final = 100.0
_MOST_NM: Final = 100.0


class SharedAuthority(NamedTuple):
    """The controller's authority over steering in SHARED, and the state of the trade: -1 the person has it, 1 not."""

    lateral: float
    trade: float


@kernel
def time_to_crossing(person_rad: float, remote_rad: float, vehicle: VehicleState, settings: ControlSettings) -> float:
    """Return in how many s the person's steering would leave the lane whose middle the controller follows, at most 100.

    Both as constant curvatures tan(angle) / wheelbase from here: they are 1/2 (difference) speed^2 t^2 apart after t.
    """
    apart = lateral_apart(person_rad, remote_rad, vehicle, settings)
    if apart == 0.0:
        return NEVER_S
    return math.sqrt(clip(2.0 * settings.shared_line_margin_m / apart, 0.0, NEVER_S * NEVER_S))


@kernel
def by_line_crossing(crossing_s: float, settings: ControlSettings) -> float:
    """Return the authority for a time to line crossing: linear between calm (the fixed share) and urgent (the most)."""
    span = settings.shared_line_calm_s - settings.shared_line_urgent_s
    urgency = clip((settings.shared_line_calm_s - crossing_s) / span, 0.0, 1.0)
    return settings.shared_lateral + urgency * (settings.shared_lateral_most - settings.shared_lateral)


@kernel
def traded(trade: float, human_nm: float, person_rad: float, remote_rad: float, settings: ControlSettings) -> float:
    """Return the state of the trade after a tick: towards the person while they push away from the controller's angle.

    Args:
        trade: Of the tick before, -1 (the person's) to 1 (the controller's full share).
        human_nm: The person's torque, estimated, left-positive.
        person_rad: Where the person has the road wheels ...
        remote_rad: ... and where the controller wants them.
        settings: Threshold and rate.
    """
    against = human_nm if person_rad > remote_rad else -human_nm
    step = settings.shared_trade_per_tick
    return clip(trade - step if against >= settings.shared_trade_nm else trade + step, -1.0, 1.0)


@kernel
def shared_authority(now: TickContext, person_rad: float, remote_rad: float) -> SharedAuthority:
    """Return the controller's authority over steering that the profile's rule gives in this tick; finite angles."""
    settings = now.settings
    if settings.shared_rule == BY_LINE_CROSSING:
        crossing_s = time_to_crossing(person_rad, remote_rad, now.vehicle, settings)
        return SharedAuthority(by_line_crossing(crossing_s, settings), 1.0)
    if settings.shared_rule == TRADED:
        human_nm = clip(finite_or(now.human_nm, 0.0), -_MOST_NM, _MOST_NM)
        trade = traded(now.memory.shared_trade, human_nm, person_rad, remote_rad, settings)
        smooth = 0.5 + trade * (0.75 - 0.25 * trade * trade)
        return SharedAuthority(settings.shared_lateral * smooth, trade)
    return SharedAuthority(settings.shared_lateral, 1.0)
