"""What a controller is told of the car: the true state with the errors of its localisation."""

from simconsole.profiles.link import LinkProfile, LocalisationProfile
from simconsole.values.draws import Channel, normal, wandering
from simconsole.values.signals import VehicleState
from simconsole.values.units import RAD_PER_DEG


class Localisation:
    """Measures the car. The result depends on profile, tick and state alone: every topic of a tick tells the same."""

    def __init__(self, profile: LinkProfile) -> None:
        errors = profile.localisation
        self._seed = profile.seed
        self._errors = errors
        self._white = [
            (Channel.X, errors.position_noise_m),
            (Channel.Y, errors.position_noise_m),
            (Channel.YAW, errors.yaw_noise_deg * RAD_PER_DEG),
            (Channel.SPEED, errors.speed_noise_mps),
            (Channel.YAW_RATE, errors.yaw_rate_noise_degps * RAD_PER_DEG),
            (Channel.ACCEL_X, errors.accel_noise_mps2),
            (Channel.ACCEL_Y, errors.accel_noise_mps2),
        ]
        self._slow = [
            (Channel.DRIFT_X, errors.position_drift_m),
            (Channel.DRIFT_Y, errors.position_drift_m),
            (Channel.DRIFT_YAW, errors.yaw_drift_deg * RAD_PER_DEG),
        ]
        self.is_perfect = not any(deviation for _, deviation in (*self._white, *self._slow))

    def measure(self, vehicle: VehicleState, tick: int, tick_hz: int) -> VehicleState:
        """Return `vehicle` after `tick` as measured: pose, speed, yaw rate and accelerations have errors."""
        if self.is_perfect:
            return vehicle
        x, y, yaw, speed, rate, ax, ay = (self._noise(*white, tick) for white in self._white)
        drift_x, drift_y, drift_yaw = (self._drift(*slow, tick / tick_hz) for slow in self._slow)
        return vehicle._replace(
            x_m=vehicle.x_m + x + drift_x,
            y_m=vehicle.y_m + y + drift_y,
            yaw_rad=vehicle.yaw_rad + yaw + drift_yaw,
            vx_mps=vehicle.vx_mps + speed,
            yaw_rate_radps=vehicle.yaw_rate_radps + rate,
            ax_mps2=vehicle.ax_mps2 + ax,
            ay_mps2=vehicle.ay_mps2 + ay,
        )

    def _noise(self, channel: Channel, deviation: float, tick: int) -> float:
        return deviation * normal(self._seed, channel, tick) if deviation else 0.0

    def _drift(self, channel: Channel, deviation: float, time_s: float) -> float:
        """Return a smooth curve through independent values, `drift_time_s` apart; it begins at 0."""
        if not deviation:
            return 0.0
        return deviation * wandering(self._seed, channel, time_s / self._errors.drift_time_s)


def covariances(errors: LocalisationProfile) -> tuple[list[float], list[float]]:
    """Return the covariances (row by row, 6 x 6: x, y, z, about x, y, z) of a pose and of a twist with these errors."""
    pose, twist = [0.0] * 36, [0.0] * 36
    pose[0] = pose[7] = errors.position_noise_m**2 + errors.position_drift_m**2
    pose[35] = (errors.yaw_noise_deg * RAD_PER_DEG) ** 2 + (errors.yaw_drift_deg * RAD_PER_DEG) ** 2
    twist[0], twist[35] = errors.speed_noise_mps**2, (errors.yaw_rate_noise_degps * RAD_PER_DEG) ** 2
    return pose, twist
