"""What the wheels stand on: patches of map with a friction of their own. Looked up once a tick: 8 cm at 20 m/s."""

from simconsole.values.kernels import kernel
from simconsole.values.trigonometry import direction
from simconsole.vehicle.car.axles import FrictionShares
from simconsole.vehicle.car.parameters import CarParameters, PatchParameters
from simconsole.vehicle.car.state import Car

LEAST_SHARE = 0.01
"""A tyre without any friction would have no limit to divide by."""


@kernel
def on_patch(patch: PatchParameters, x_m: float, y_m: float, share: float) -> float:
    """Return the share of friction at a place, `share` where the patch is not."""
    if patch.from_x_m <= x_m and x_m <= patch.to_x_m and patch.from_y_m <= y_m and y_m <= patch.to_y_m:
        return patch.share if patch.share > LEAST_SHARE else LEAST_SHARE
    return share


@kernel
def share_at(p: CarParameters, x_m: float, y_m: float) -> float:
    """Return the share of the ground's friction at a place in map: that of the last patch there."""
    share = on_patch(p.patch_1, x_m, y_m, 1.0)
    share = on_patch(p.patch_2, x_m, y_m, share)
    share = on_patch(p.patch_3, x_m, y_m, share)
    return on_patch(p.patch_4, x_m, y_m, share)


@kernel
def friction_shares(car: Car, p: CarParameters) -> FrictionShares:
    """Return the share of the ground's friction under each wheel."""
    if p.patch_1.from_x_m <= p.patch_1.to_x_m:
        return _shares_on_patches(car, p)
    return FrictionShares(1.0, 1.0, 1.0, 1.0)


@kernel
def _shares_on_patches(car: Car, p: CarParameters) -> FrictionShares:
    """Return the same where there is a patch at all."""
    body = car.body
    ahead = direction(body.yaw_rad)
    rear = p.rear.half_track_m
    front = p.front.half_track_m
    x = body.x_m + (p.front.ahead_m - p.rear.ahead_m) * ahead.cos
    y = body.y_m + (p.front.ahead_m - p.rear.ahead_m) * ahead.sin
    return FrictionShares(
        share_at(p, x - front * ahead.sin, y + front * ahead.cos),
        share_at(p, x + front * ahead.sin, y - front * ahead.cos),
        share_at(p, body.x_m - rear * ahead.sin, body.y_m + rear * ahead.cos),
        share_at(p, body.x_m + rear * ahead.sin, body.y_m - rear * ahead.cos),
    )
