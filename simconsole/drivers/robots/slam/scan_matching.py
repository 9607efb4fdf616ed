"""Where a scan fits into a map: Gauss and Newton's method from each echo to the line of the echoes that the map has.

The lines are those of three by three cells: matching is from point to line (Censi, ICRA 2008), with lines as in the
normal distributions transform (Biber and Strasser, IROS 2003). Odometry counts as a measurement, too: in a corridor it
holds along the walls.
"""

from math import sqrt
from typing import Final, NamedTuple

from simconsole.drivers.robots.slam.hit_map import FREE_BELOW, HitMap, cell_at
from simconsole.values.kernels import Row, kernel
from simconsole.values.trigonometry import cos, sin

ECHO_M: Final = 0.012
"""Standard deviation of an echo about its wall."""
_FEWEST: Final = 3.0
_LONG_M2: Final = 0.0004  # least variance along a line: of less, noise gives the direction
_SLENDER: Final = 4.0  # least variance along a line, over that across it
_NEAR: Final = 3.0  # standard deviations
_ITERATIONS: Final = 15
_DONE: Final = 1e-5


class Prior(NamedTuple):
    """What odometry says: a pose in map, and the inverse of its variances."""

    x_m: float
    y_m: float
    yaw_rad: float
    per_m2: float
    per_rad2: float


class Fit(NamedTuple):
    """The pose at which a scan fits best, and how well."""

    x_m: float
    y_m: float
    yaw_rad: float
    near: float  # echoes on a line of the map
    off: float  # echoes beside one, or in the midst of what is free
    xx: float  # the information that the pose is known by: the upper half of a symmetric matrix
    xy: float
    xa: float
    yy: float
    ya: float
    aa: float


class Line(NamedTuple):
    """The line of the echoes about a place; `x` and `y` of its normal are 0 where there is none."""

    x_m: float  # a point on it
    y_m: float
    normal_x: float
    normal_y: float
    variance_m2: float  # of echoes across it


class Misses(NamedTuple):
    """Sums over the echoes of a scan: Gauss and Newton's equations without the prior."""

    near: float
    off: float
    xx: float
    xy: float
    xa: float
    yy: float
    ya: float
    aa: float
    x: float
    y: float
    a: float


@kernel
def fitted(field: HitMap, points_m: Row, prior: Prior) -> Fit:
    """Return the pose of a scan.

    Args:
        field: the map.
        points_m: float64 [N, 2]: echoes in the frame of the robot's base.
        prior: where odometry has it.
    """
    x = prior.x_m
    y = prior.y_m
    yaw = prior.yaw_rad
    sums = misses(field, points_m, x, y, yaw)
    for _ in range(_ITERATIONS):
        xx = sums.xx + prior.per_m2
        yy = sums.yy + prior.per_m2
        aa = sums.aa + prior.per_rad2
        right_x = -(sums.x + prior.per_m2 * (x - prior.x_m))
        right_y = -(sums.y + prior.per_m2 * (y - prior.y_m))
        right_a = -(sums.a + prior.per_rad2 * (yaw - prior.yaw_rad))
        # Cholesky's factors; the prior keeps all of them above 0.
        d = sqrt(xx)
        e = sums.xy / d
        f = sums.xa / d
        g = sqrt(yy - e * e)
        h = (sums.ya - e * f) / g
        i = sqrt(aa - f * f - h * h)
        u = right_x / d
        v = (right_y - e * u) / g
        step_a = (right_a - f * u - h * v) / i / i
        step_y = (v - h * step_a) / g
        step_x = (u - e * step_y - f * step_a) / d
        x += step_x
        y += step_y
        yaw += step_a
        sums = misses(field, points_m, x, y, yaw)
        if abs(step_x) + abs(step_y) + abs(step_a) < _DONE:
            break
    return Fit(
        x_m=x,
        y_m=y,
        yaw_rad=yaw,
        near=sums.near,
        off=sums.off,
        xx=sums.xx + prior.per_m2,
        xy=sums.xy,
        xa=sums.xa,
        yy=sums.yy + prior.per_m2,
        ya=sums.ya,
        aa=sums.aa + prior.per_rad2,
    )


@kernel
def misses(field: HitMap, points_m: Row, x_m: float, y_m: float, yaw_rad: float) -> Misses:
    """Return the sums for a scan at a pose. An echo counts less, the further it is from its line (Geman, McClure)."""
    near = off = xx = xy = xa = yy = ya = aa = sum_x = sum_y = sum_a = 0.0
    c = cos(yaw_rad)
    s = sin(yaw_rad)
    for index in range(len(points_m)):
        arm_x = c * points_m[index, 0] - s * points_m[index, 1]
        arm_y = s * points_m[index, 0] + c * points_m[index, 1]
        line = line_at(field, x_m + arm_x, y_m + arm_y)
        if line.normal_x == 0.0 and line.normal_y == 0.0:
            cell = cell_at(field, x_m + arm_x, y_m + arm_y)
            if cell >= 0 and field.log_odds[cell] < 2.0 * FREE_BELOW:
                off += 1.0
            continue
        away = line.normal_x * (x_m + arm_x - line.x_m) + line.normal_y * (y_m + arm_y - line.y_m)
        variance = ECHO_M * ECHO_M + line.variance_m2
        if away * away < _NEAR * _NEAR * variance:
            near += 1.0
        else:
            off += 1.0
        doubt = 1.0 + away * away / (_NEAR * _NEAR * variance)
        weight = 1.0 / (variance * doubt * doubt)
        lever = line.normal_y * arm_x - line.normal_x * arm_y
        xx += weight * line.normal_x * line.normal_x
        xy += weight * line.normal_x * line.normal_y
        xa += weight * line.normal_x * lever
        yy += weight * line.normal_y * line.normal_y
        ya += weight * line.normal_y * lever
        aa += weight * lever * lever
        sum_x += weight * line.normal_x * away
        sum_y += weight * line.normal_y * away
        sum_a += weight * lever * away
    return Misses(
        near=near,
        off=off,
        xx=xx,
        xy=xy,
        xa=xa,
        yy=yy,
        ya=ya,
        aa=aa,
        x=sum_x,
        y=sum_y,
        a=sum_a,
    )


@kernel
def line_at(field: HitMap, x_m: float, y_m: float) -> Line:
    """Return the line of the echoes in the cell of a place and its neighbours."""
    cell = cell_at(field, x_m, y_m)
    if cell < 0:
        return Line(0.0, 0.0, 0.0, 0.0, 0.0)
    row = cell // field.columns
    column = cell - row * field.columns
    if row < 1 or column < 1 or row > field.rows - 2 or column > field.columns - 2:
        return Line(0.0, 0.0, 0.0, 0.0, 0.0)
    count = sum_x = sum_y = sum_xx = sum_xy = sum_yy = 0.0
    for down in range(-1, 2):
        for right in range(-1, 2):
            at = cell + down * field.columns + right
            if field.log_odds[at] > 0.0:
                count += field.hits[at, 0]
                sum_x += field.hits[at, 1]
                sum_y += field.hits[at, 2]
                sum_xx += field.hits[at, 3]
                sum_xy += field.hits[at, 4]
                sum_yy += field.hits[at, 5]
    if count < _FEWEST:
        return Line(0.0, 0.0, 0.0, 0.0, 0.0)
    middle_x = sum_x / count
    middle_y = sum_y / count
    xx = sum_xx / count - middle_x * middle_x
    xy = sum_xy / count - middle_x * middle_y
    yy = sum_yy / count - middle_y * middle_y
    apart = sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy)
    along = 0.5 * (xx + yy) + apart
    across = 0.5 * (xx + yy) - apart
    if across < 0.0:  # rounded
        across = 0.0
    if along < _LONG_M2 or along < _SLENDER * across:
        return Line(0.0, 0.0, 0.0, 0.0, 0.0)
    # Of the eigenvector's two forms that whose difference loses no digits.
    if xx > yy:
        normal_x = -xy
        normal_y = 0.5 * (xx - yy) + apart
    else:
        normal_x = 0.5 * (yy - xx) + apart
        normal_y = -xy
    length = sqrt(normal_x * normal_x + normal_y * normal_y)
    return Line(middle_x, middle_y, normal_x / length, normal_y / length, across)


@kernel
def searched(field: HitMap, points_m: Row, prior: Prior, reach_m: float, reach_rad: float) -> Prior:
    """Return the pose about the prior's at which most echoes of a scan lie on occupied cells.

    For a robot that has slipped or was pushed: `fitted` finds the pose only from near it. Every fourth echo is looked
    at, and every pose at steps of half a cell and 0.02 rad.
    """
    best = prior
    most = -1.0
    step = 0.5 * field.cell_m
    turns = int(reach_rad / 0.02)
    steps = int(reach_m / step)
    for turn in range(-turns, turns + 1):
        yaw = prior.yaw_rad + 0.02 * turn
        c = cos(yaw)
        s = sin(yaw)
        for up in range(-steps, steps + 1):
            for right in range(-steps, steps + 1):
                x = prior.x_m + step * right
                y = prior.y_m + step * up
                hits = 0.0
                for index in range(0, len(points_m), 4):
                    cell = cell_at(
                        field,
                        x + c * points_m[index, 0] - s * points_m[index, 1],
                        y + s * points_m[index, 0] + c * points_m[index, 1],
                    )
                    if cell >= 0 and field.log_odds[cell] > 0.0:
                        hits += 1.0
                hits -= 0.01 * (abs(turn) + abs(up) + abs(right))  # of equal ones the nearest
                if hits > most:
                    most = hits
                    best = Prior(x, y, yaw, prior.per_m2, prior.per_rad2)
    return best
