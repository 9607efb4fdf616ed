"""How imperfect the link to a controller is: what it measures of the car, and how late its commands act."""

from typing import Annotated, Final

from msgspec import Meta, Struct

LONGEST_MS: Final = 2000.0
Milliseconds = Annotated[float, Meta(ge=0.0, le=LONGEST_MS)]
Share = Annotated[float, Meta(ge=0.0, le=1.0)]


class LocalisationProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Errors of odometry, /tf and velocity report against the true state. Noise is white: drawn anew for each tick."""

    position_noise_m: Annotated[float, Meta(ge=0.0, le=10.0)] = 0.0
    """Standard deviation of the noise of the position, along x and along y."""
    yaw_noise_deg: Annotated[float, Meta(ge=0.0, le=45.0)] = 0.0
    """Standard deviation of the noise of the heading."""
    speed_noise_mps: Annotated[float, Meta(ge=0.0, le=10.0)] = 0.0
    """Standard deviation of the noise of the speed."""
    yaw_rate_noise_degps: Annotated[float, Meta(ge=0.0, le=45.0)] = 0.0
    """Standard deviation of the noise of the yaw rate."""
    accel_noise_mps2: Annotated[float, Meta(ge=0.0, le=10.0)] = 0.0
    """Standard deviation of the noise of the acceleration in /imu/data."""
    position_drift_m: Annotated[float, Meta(ge=0.0, le=100.0)] = 0.0
    """Standard deviation of an error of the position that changes slowly, along x and along y."""
    yaw_drift_deg: Annotated[float, Meta(ge=0.0, le=45.0)] = 0.0
    """Standard deviation of an error of the heading that changes slowly."""
    drift_time_s: Annotated[float, Meta(ge=1.0, le=3600.0)] = 20.0
    """How long a drift takes from one value to an independent one."""


class WayProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What happens to messages on their way, each by itself; added to what the sockets take, in whole ticks."""

    delay_ms: Milliseconds = 0.0
    """How much later each message arrives."""
    jitter_ms: Milliseconds = 0.0
    """Each message arrives up to this much later still, drawn evenly: messages overtake each other."""
    loss_share: Share = 0.0
    """Share of the messages that never arrive, 0 to 1."""


class LinkProfile(WayProfile, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The link of a controller on the ROS side; without anything set it is perfect, as far as sockets are.

    Its own delay, jitter and loss are those of commands, from the state that a command answers (or from when that
    arrived) to the tick in which it acts; a command that is overtaken is dropped as out of order.
    """

    seed: Annotated[int, Meta(ge=0, le=2**53)] = 1
    """Number that errors, delays and losses are drawn from: equal seeds give equal drives."""
    localisation: LocalisationProfile = LocalisationProfile()
    """Errors of what the controller is told of the car's own motion; without it none."""
    measurements: WayProfile = WayProfile()
    """Delay and loss of what a controller is told of vehicle and road users: /odom, /tf, /imu/data and the like."""
    ground_truth: bool = False
    """Publish /ground_truth/odom although the localisation has errors, or measurements come late or never."""


def late_ms(link: LinkProfile) -> float:
    """Return the mean time from a measurement to the tick in which the command that answers it acts."""
    there = link.measurements
    return there.delay_ms + 0.5 * there.jitter_ms + link.delay_ms + 0.5 * link.jitter_ms


def link_label(link: LinkProfile) -> str:
    """Return what the link is like, in words for people."""
    errors, parts = link.localisation, []
    for value, unit, what in (
        (errors.position_noise_m * 100.0, "cm", "noise of position"),
        (errors.yaw_noise_deg, "deg", "noise of yaw"),
        (errors.position_drift_m * 100.0, "cm", "drift of position"),
        (errors.yaw_drift_deg, "deg", "drift of yaw"),
        (errors.speed_noise_mps, "m/s", "noise of speed"),
        (errors.yaw_rate_noise_degps, "deg/s", "noise of yaw rate"),
        (link.delay_ms, "ms", "delay"),
        (link.jitter_ms, "ms", "jitter"),
        (link.loss_share * 100.0, "%", "loss"),
        (link.measurements.delay_ms, "ms", "delay of measurements"),
        (link.measurements.jitter_ms, "ms", "jitter of measurements"),
        (link.measurements.loss_share * 100.0, "%", "loss of measurements"),
    ):
        if value:
            parts.append(f"{value:g} {unit} {what}")
    return ", ".join(parts) or "perfect odometry, no delay"
