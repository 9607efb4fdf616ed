"""Whom the console's vehicle runs into, or who runs into it: what that does to both. Pure."""

import math
from collections.abc import Callable, Iterable
from typing import Any, Final, NamedTuple

from simconsole.values.platform import Solid
from simconsole.values.signals import NO_IMPACT, ImpactInput, VehicleState
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.collisions import Struck, box_of
from simconsole.world.traffic.impact import Moving, collide, contact_of
from simconsole.world.traffic.road_users import Box, RoadUser, RoadUserKind

MASSES_KG: Final = {RoadUserKind.CAR: 1400.0, RoadUserKind.VAN: 2200.0, RoadUserKind.PEDESTRIAN: 75.0}


class Crash(NamedTuple):
    """What the touches of one step of traffic do."""

    new: frozenset[float]  # numbers of those who were not touched before
    impact: ImpactInput  # on the vehicle
    pushed: tuple[tuple[float, float], ...]  # on others: number, change of speed along their heading (m/s)


NO_CRASH: Final = Crash(frozenset(), NO_IMPACT, ())


class Crashes:
    """Looks for touches after each step of traffic; who goes on touching is pushed on, but no new collision."""

    def __init__(
        self, solid: Solid | None, execution: Callable[[Any], Any], moves: Callable[[RoadUser], Moving] | None = None
    ) -> None:
        """Take the vehicle's body; without one its touches are told, but move nobody.

        `moves` tells how a road user moves as a body; without it that is guessed by kind and size.
        """
        self._solid, self._struck, self._moves = solid, Struck(execution), moves or guessed
        self._touched: frozenset[float] = frozenset()

    def step(self, vehicle: VehicleState, ego: Box, users: Array) -> Crash:
        """Return what touches of the vehicle, whose footprint is `ego`, and users, float64 [users, FIELDS], do."""
        some = self._struck.by(ego, users)
        before, self._touched = self._touched, frozenset(user.id for user in some)
        if not some:
            return NO_CRASH
        new = self._touched - before
        # A person is thrown aside by the first touch: they do not go on pushing.
        heavy = (user for user in some if user.kind != RoadUserKind.PEDESTRIAN or user.id in new)
        first = 1.0 if new else 0.0
        if self._solid is None:
            return Crash(new, NO_IMPACT._replace(first_touch=first), ())
        others = [(user, self._moves(user)) for user in heavy]
        impact, pushed = _impacts(motion_of(vehicle, self._solid), vehicle.yaw_rad, ego, others)
        return Crash(new, impact._replace(first_touch=first), pushed)


def _impacts(
    own: Moving, yaw_rad: float, ego: Box, users: Iterable[tuple[RoadUser, Moving]]
) -> tuple[ImpactInput, tuple[tuple[float, float], ...]]:
    """Return what users do to the vehicle, one after the other, and it to them."""
    start, pushed = own, []
    for user, other in users:
        box = box_of(user)
        contact = contact_of(ego, box, (own.vx_mps - other.vx_mps, own.vy_mps - other.vy_mps))
        changes = None if contact is None else collide(own, other, contact)
        if changes is None:
            continue
        mine, theirs = changes
        own = own._replace(
            vx_mps=own.vx_mps + mine.vx_mps,
            vy_mps=own.vy_mps + mine.vy_mps,
            yaw_rate_radps=own.yaw_rate_radps + mine.yaw_rate_radps,
        )
        along = theirs.vx_mps * math.cos(user.yaw_rad) + theirs.vy_mps * math.sin(user.yaw_rad)
        pushed.append((user.id, along))
    dx, dy = own.vx_mps - start.vx_mps, own.vy_mps - start.vy_mps
    cosine, sine = math.cos(yaw_rad), math.sin(yaw_rad)
    impact = ImpactInput(
        first_touch=0.0,
        vx_mps=dx * cosine + dy * sine,
        vy_mps=dy * cosine - dx * sine,
        yaw_rate_radps=own.yaw_rate_radps - start.yaw_rate_radps,
    )
    return impact, tuple(pushed)


def motion_of(vehicle: VehicleState, solid: Solid) -> Moving:
    """Return how the console's vehicle moves as a body."""
    cosine, sine = math.cos(vehicle.yaw_rad), math.sin(vehicle.yaw_rad)
    vx, vy = vehicle.vx_mps, vehicle.vy_mps + solid.cg_ahead_m * vehicle.yaw_rate_radps
    return Moving(
        mass_kg=solid.mass_kg,
        yaw_inertia_kgm2=solid.yaw_inertia_kgm2,
        x_m=vehicle.x_m + solid.cg_ahead_m * cosine,
        y_m=vehicle.y_m + solid.cg_ahead_m * sine,
        vx_mps=vx * cosine - vy * sine,
        vy_mps=vx * sine + vy * cosine,
        yaw_rate_radps=vehicle.yaw_rate_radps,
    )


def guessed(user: RoadUser) -> Moving:
    """Return how a road user moves as a body, by its kind and size."""
    return box_moving(user, MASSES_KG[RoadUserKind(int(user.kind))])


def box_moving(user: RoadUser, mass_kg: float) -> Moving:
    """Return how a road user moves if it is a box that its mass fills evenly, and drives straight on."""
    return Moving(
        mass_kg=mass_kg,
        yaw_inertia_kgm2=mass_kg * (user.length_m**2 + user.width_m**2) / 12.0,
        x_m=user.x_m,
        y_m=user.y_m,
        vx_mps=user.speed_mps * math.cos(user.yaw_rad),
        vy_mps=user.speed_mps * math.sin(user.yaw_rad),
        yaw_rate_radps=0.0,
    )
