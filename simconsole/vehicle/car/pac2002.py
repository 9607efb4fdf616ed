"""PAC2002: force and aligning moment of a tyre in steady slip, pure and combined.

The equations of Adams/Tire PAC2002 (MSC Software; after Pacejka, Tyre and Vehicle Dynamics, 2002), as the files' frame
has them: ISO, a slip angle is positive where the contact patch slides to the left, and `PKY1` is negative. A number in
brackets is that of the equation in the Adams manual, as OpenTirePython names it. The manual itself was not at hand:
checked are the numbers, against OpenTirePython (all of force and moment, to 1e-13 of the load, tests/vehicle/
test_tir_published.py), and against CommonRoad's tyre (forces); and by reading, against Project Chrono's ChPac02Tire
(`LFZO`, friction ellipse). Chrono differs from all the others in `1 + PDY3 gamma^2` and the sign of the equivalent
slip. Not here: turn slip, inflation pressure, overturning couple and rolling resistance of the file.
"""

from collections.abc import Callable
from math import sqrt
from typing import Final, NamedTuple

from simconsole.profiles.tyre import NEEDED, ONE, ZERO
from simconsole.values.kernels import clip, kernel
from simconsole.values.trigonometry import HALF_PI, atan, cos, sin

LEAST_LOAD_N: Final = 1.0
_TWO_OVER_PI: Final = 1.0 / HALF_PI
_MOST_EXPONENT: Final = 20.0


class Pac2002(NamedTuple):
    """The coefficients, named as in the file."""

    fnomin: float
    unloaded_radius: float
    pcx1: float
    pdx1: float
    pkx1: float
    pcy1: float
    pdy1: float
    pky1: float
    pky2: float
    qbz1: float
    qcz1: float
    qdz1: float
    pdx2: float
    pdx3: float
    pex1: float
    pex2: float
    pex3: float
    pex4: float
    pkx2: float
    pkx3: float
    phx1: float
    phx2: float
    pvx1: float
    pvx2: float
    pdy2: float
    pdy3: float
    pey1: float
    pey2: float
    pey3: float
    pey4: float
    pky3: float
    phy1: float
    phy2: float
    phy3: float
    pvy1: float
    pvy2: float
    pvy3: float
    pvy4: float
    qbz2: float
    qbz3: float
    qbz4: float
    qbz5: float
    qbz9: float
    qbz10: float
    qdz2: float
    qdz3: float
    qdz4: float
    qdz6: float
    qdz7: float
    qdz8: float
    qdz9: float
    qez1: float
    qez2: float
    qez3: float
    qez4: float
    qez5: float
    qhz1: float
    qhz2: float
    qhz3: float
    qhz4: float
    ssz1: float
    ssz2: float
    ssz3: float
    ssz4: float
    rbx1: float
    rcx1: float
    rby1: float
    rcy1: float
    rbx2: float
    rex1: float
    rex2: float
    rhx1: float
    rby2: float
    rby3: float
    rey1: float
    rey2: float
    rhy1: float
    rhy2: float
    rvy1: float
    rvy2: float
    rvy3: float
    rvy4: float
    rvy5: float
    rvy6: float
    lfzo: float
    lcx: float
    lmux: float
    lex: float
    lkx: float
    lhx: float
    lvx: float
    lcy: float
    lmuy: float
    ley: float
    lky: float
    lhy: float
    lvy: float
    lgax: float
    lgay: float
    lgaz: float
    ltr: float
    lres: float
    lxal: float
    lyka: float
    lvyka: float
    ls: float
    tyreside: float  # on which the tyre was measured: 1 left, -1 right


class Slip(NamedTuple):
    """How the tyre moves over the ground, and under which load."""

    along: float  # longitudinal slip: positive drives
    across: float  # tangent of the slip angle: positive slides to the left
    load_n: float
    camber_rad: float  # positive leans to the right
    friction: float  # of the ground: scales both LMUX and LMUY


class Force(NamedTuple):
    """On the car, in the frame of the wheel: x ahead, y to the left, moment left-positive."""

    x_n: float
    y_n: float
    moment_nm: float
    peak_x_n: float
    peak_y_n: float


class Side(NamedTuple):
    """Pure side force and what the moment needs of it."""

    force_n: float
    peak_n: float
    stiffness_n: float  # per rad, negative
    bc: float
    shift: float  # of the slip angle where the residual moment is
    lift_n: float  # of the force where the shifted angle is none


def coefficients(values: dict[str, float]) -> Pac2002:
    """Return the coefficients with those that the file leaves out: 0, scale factors 1, measured left."""
    full = dict.fromkeys(ZERO, 0.0) | dict.fromkeys(ONE, 1.0) | values
    return Pac2002(**{key.lower(): float(full[key]) for key in (*NEEDED, *ZERO, *ONE)})


@kernel
def exp(value: float) -> float:
    """Return e to the `value`, limited to -20..20: relative error below 1e-13. Series of a 256th, squared 8 times."""
    x = clip(value, -_MOST_EXPONENT, _MOST_EXPONENT) * 0.00390625
    tail = 1.0 + x * (1.0 / 6.0) * (1.0 + x * (1.0 / 7.0) * (1.0 + x * 0.125))
    small = 1.0 + x * (1.0 + x * 0.5 * (1.0 + x * (1.0 / 3.0) * (1.0 + x * 0.25 * (1.0 + x * 0.2 * tail))))
    for _ in range(8):
        small = small * small
    return small


@kernel
def sign(value: float) -> float:
    """Return -1, 0 or 1."""
    if value > 0.0:
        return 1.0
    return -1.0 if value < 0.0 else 0.0


@kernel
def below_one(value: float) -> float:
    """Return a curvature factor as the model limits it: at most 1."""
    return value if value < 1.0 else 1.0


@kernel
def bend(bx: float, curvature: float) -> float:
    """Return the argument inside the outer function of the Magic Formula: atan(Bx - E (Bx - atan Bx))."""
    return atan(bx - curvature * (bx - atan(bx)))


@kernel
def over_nominal(p: Pac2002, load_n: float) -> float:
    """Return the load's share above the nominal one."""
    nominal = p.fnomin * p.lfzo
    return (load_n - nominal) / nominal


@kernel
def stiffness_x(p: Pac2002, load_n: float) -> float:
    """Return the slope of the longitudinal force over slip at none, in N (25)."""
    dfz = over_nominal(p, load_n)
    return load_n * (p.pkx1 + p.pkx2 * dfz) * exp(p.pkx3 * dfz) * p.lkx


@kernel
def stiffness_y(p: Pac2002, load_n: float, camber_rad: float) -> float:
    """Return the slope of the side force over slip angle at none, in N/rad: negative (37, 38)."""
    nominal = p.fnomin * p.lfzo
    upright = p.pky1 * nominal * sin(2.0 * atan(load_n / (p.pky2 * nominal))) * p.lky
    return upright * (1.0 - p.pky3 * abs(camber_rad * p.lgay))


@kernel
def peak(first: float, second: float, third: float, dfz: float, camber_rad: float) -> float:
    """Return the friction of one direction (23, 35); falling loads and cambers leave a little."""
    value = (first + second * dfz) * (1.0 - third * camber_rad * camber_rad)
    return value if value > 0.01 else 0.01


@kernel
def peak_x(p: Pac2002, s: Slip) -> float:
    """Return the largest longitudinal force in N, shifts aside (22)."""
    share = peak(p.pdx1, p.pdx2, p.pdx3, over_nominal(p, s.load_n), s.camber_rad * p.lgax)
    return share * (p.lmux * s.friction) * s.load_n


@kernel
def peak_y(p: Pac2002, s: Slip) -> float:
    """Return the largest side force in N, shifts aside (34)."""
    share = peak(p.pdy1, p.pdy2, p.pdy3, over_nominal(p, s.load_n), s.camber_rad * p.lgay)
    return share * (p.lmuy * s.friction) * s.load_n


@kernel
def pure_x(p: Pac2002, s: Slip) -> Force:
    """Return the longitudinal force without side slip, and its peak (18 to 28)."""
    dfz = over_nominal(p, s.load_n)
    scale = p.lmux * s.friction
    d = peak_x(p, s)
    c = p.pcx1 * p.lcx
    slip = s.along + (p.phx1 + p.phx2 * dfz) * p.lhx
    e = below_one((p.pex1 + p.pex2 * dfz + p.pex3 * dfz * dfz) * (1.0 - p.pex4 * sign(slip)) * p.lex)
    b = stiffness_x(p, s.load_n) / (c * d)
    lift = s.load_n * (p.pvx1 + p.pvx2 * dfz) * p.lvx * scale
    return Force(d * sin(c * bend(b * slip, e)) + lift, 0.0, 0.0, d, 0.0)


@kernel
def pure_y(p: Pac2002, s: Slip, alpha_rad: float) -> Side:
    """Return the side force without longitudinal slip (30 to 41)."""
    dfz = over_nominal(p, s.load_n)
    scale = p.lmuy * s.friction
    lean = s.camber_rad * p.lgay
    d = peak_y(p, s)
    c = p.pcy1 * p.lcy
    shift = (p.phy1 + p.phy2 * dfz) * p.lhy + p.phy3 * lean
    angle = alpha_rad + shift
    e = below_one((p.pey1 + p.pey2 * dfz) * (1.0 - (p.pey3 + p.pey4 * lean) * sign(angle)) * p.ley)
    k = stiffness_y(p, s.load_n, s.camber_rad)
    b = k / (c * d)
    lift = s.load_n * ((p.pvy1 + p.pvy2 * dfz) * p.lvy + (p.pvy3 + p.pvy4 * dfz) * lean) * scale
    return Side(
        force_n=d * sin(c * bend(b * angle, e)) + lift,
        peak_n=d,
        stiffness_n=k,
        bc=b * c,
        shift=shift + lift / k,
        lift_n=lift,
    )


@kernel
def weight(b: float, c: float, e: float, slip: float, shift: float) -> float:
    """Return the share of the pure force that the other slip leaves: 1 without it (66, 77)."""
    return cos(c * bend(b * (slip + shift), e)) / cos(c * bend(b * shift, e))


@kernel
def combined_angle(tangent: float, other: float) -> float:
    """Return the equivalent slip angle of both slips, with the sign of `tangent` (84, 85)."""
    return atan(sqrt(tangent * tangent + other * other)) * sign(tangent)


@kernel
def moment(p: Pac2002, s: Slip, alpha_rad: float, side: Side, plain_y_n: float, x_n: float, y_n: float) -> float:
    """Return the aligning moment: pneumatic trail, residual moment and the longitudinal force's arm (44 to 56)."""
    dfz = over_nominal(p, s.load_n)
    lean = s.camber_rad * p.lgaz
    scale = p.lmuy * s.friction
    other = stiffness_x(p, s.load_n) / side.stiffness_n * s.along
    angle = alpha_rad + p.qhz1 + p.qhz2 * dfz + (p.qhz3 + p.qhz4 * dfz) * lean
    b = (p.qbz1 + p.qbz2 * dfz + p.qbz3 * dfz * dfz) * (1.0 + p.qbz4 * lean + p.qbz5 * abs(lean)) * p.lky / scale
    e = (p.qez1 + p.qez2 * dfz + p.qez3 * dfz * dfz) * (
        1.0 + (p.qez4 + p.qez5 * lean) * _TWO_OVER_PI * atan(b * p.qcz1 * angle)
    )
    arm = s.load_n * (p.qdz1 + p.qdz2 * dfz) * (1.0 + p.qdz3 * lean + p.qdz4 * lean * lean)
    arm = arm * p.unloaded_radius / (p.fnomin * p.lfzo) * p.ltr
    along = cos(alpha_rad)
    trail = arm * cos(p.qcz1 * bend(b * combined_angle(tan(angle), other), below_one(e))) * along
    left = (p.qdz6 + p.qdz7 * dfz) * p.lres + (p.qdz8 + p.qdz9 * dfz) * lean
    b_left = p.qbz9 * p.lky / scale + p.qbz10 * side.bc
    angle_left = combined_angle(tan(alpha_rad + side.shift), other)
    residual = s.load_n * left * p.unloaded_radius * scale * cos(atan(b_left * angle_left)) * along
    lever = p.ssz1 + p.ssz2 * y_n / (p.fnomin * p.lfzo) + (p.ssz3 + p.ssz4 * dfz) * s.camber_rad
    return -trail * plain_y_n + residual + lever * p.unloaded_radius * p.ls * x_n


@kernel
def tan(angle_rad: float) -> float:
    """Return the tangent, of an angle within a right angle."""
    angle = clip(angle_rad, -1.55, 1.55)
    return sin(angle) / cos(angle)


@kernel
def shared(own: float, other: float, used: float) -> float:
    """Return the share of a pure force that both slips leave, `used` of the other direction's grip per slip of it."""
    both = sqrt(own * own + other * used * (other * used))
    return abs(own) / both if both > 0.0 else 1.0


@kernel
def loaded(given: Slip) -> Slip:
    """Return the slip with a load of at least LEAST_LOAD_N."""
    load = given.load_n if given.load_n > LEAST_LOAD_N else LEAST_LOAD_N
    return Slip(given.along, given.across, load, given.camber_rad, given.friction)


@kernel
def elliptic(p: Pac2002, given: Slip) -> Force:
    """Return force and moment of a file that has no coefficients of combined slip: the friction ellipse of Adams.

    As Chrono's ChPac02Tire writes it, with the tangent of its angle beta for the angle: sin(alpha) over kappa, shifts
    included. Its moment is that of pure side slip with the side force that is left.
    """
    s = loaded(given)
    dfz = over_nominal(p, s.load_n)
    alpha = atan(s.across)
    ahead = pure_x(p, s)
    side = pure_y(p, s, alpha)
    lift_x = s.load_n * (p.pvx1 + p.pvx2 * dfz) * p.lvx * (p.lmux * s.friction)
    along = s.along + (p.phx1 + p.phx2 * dfz) * p.lhx + lift_x / stiffness_x(p, s.load_n)
    across = sin(alpha + side.shift)
    x = ahead.x_n * shared(along, across, (ahead.x_n - lift_x) / side.peak_n)
    y = side.force_n * shared(across, along, (side.force_n - side.lift_n) / ahead.peak_x_n)
    pure = Slip(0.0, s.across, s.load_n, s.camber_rad, s.friction)
    return Force(x, y, moment(p, pure, alpha, side, y, x, y), ahead.peak_x_n, side.peak_n)


@kernel
def pac2002(p: Pac2002, given: Slip) -> Force:
    """Return force and moment under both slips; the load counts as at least LEAST_LOAD_N."""
    s = loaded(given)
    dfz = over_nominal(p, s.load_n)
    alpha = atan(s.across)
    ahead = pure_x(p, s)
    side = pure_y(p, s, alpha)
    b = p.rbx1 * cos(atan(p.rbx2 * s.along)) * p.lxal
    x = ahead.x_n * weight(b, p.rcx1, below_one(p.rex1 + p.rex2 * dfz), alpha, p.rhx1)
    b = p.rby1 * cos(atan(p.rby2 * (alpha - p.rby3))) * p.lyka
    plain = side.force_n * weight(b, p.rcy1, below_one(p.rey1 + p.rey2 * dfz), s.along, p.rhy1 + p.rhy2 * dfz)
    steer = side.peak_n * (p.rvy1 + p.rvy2 * dfz + p.rvy3 * s.camber_rad) * cos(atan(p.rvy4 * alpha))
    y = plain + steer * sin(p.rvy5 * atan(p.rvy6 * s.along)) * p.lvyka
    return Force(x, y, moment(p, s, alpha, side, plain, x, y), ahead.peak_x_n, side.peak_n)


def steady(p: Pac2002) -> Callable[[Pac2002, Slip], Force]:
    """Return how a tyre of these coefficients combines both slips."""
    return elliptic if p.rbx1 == 0.0 and p.rby1 == 0.0 else pac2002
