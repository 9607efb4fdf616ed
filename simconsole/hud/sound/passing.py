"""Other road users, placed around the listener."""

import math
from collections.abc import Iterable
from typing import Final

import numpy as np

from simconsole.hud.sound.directions import CHANNELS, Samples, gains
from simconsole.hud.sound.heard import OtherHeard
from simconsole.hud.sound.loops import Needle, noise_loop
from simconsole.values.state_vector import Snapshot
from simconsole.world.traffic.road_users import RoadUser, RoadUserKind

NEAREST: Final = 6
FARTHEST_M: Final = 80.0
NEAR_M: Final = 4.0
"""Nearer than this nobody gets louder."""
LEVEL: Final = 0.5
FULL_MPS: Final = 14.0
SOUND_MPS: Final = 343.0
"""Speed of sound at 20 degrees Celsius."""


def audible(snapshot: Snapshot, users: Iterable[RoadUser], ear_x_m: float) -> tuple[OtherHeard, ...]:
    """Return the nearest vehicles among road users, as heard by a driver `ear_x_m` ahead of base_link."""
    vehicle = snapshot.vehicle
    cos, sin = math.cos(vehicle.yaw_rad), math.sin(vehicle.yaw_rad)
    found = []
    for user in users:
        if user.kind == RoadUserKind.PEDESTRIAN:
            continue
        away_x, away_y = user.x_m - vehicle.x_m, user.y_m - vehicle.y_m
        ahead_m, left_m = cos * away_x + sin * away_y - ear_x_m, cos * away_y - sin * away_x
        distance_m = math.hypot(ahead_m, left_m)
        if distance_m > FARTHEST_M:
            continue
        turned = user.yaw_rad - vehicle.yaw_rad
        along = user.speed_mps * math.cos(turned) - vehicle.vx_mps
        aside = user.speed_mps * math.sin(turned) - vehicle.vy_mps
        closing = -(along * ahead_m + aside * left_m) / max(distance_m, 0.1)
        found.append(
            OtherHeard(
                id=user.id,
                bearing_rad=math.atan2(left_m, ahead_m),
                distance_m=distance_m,
                speed_mps=user.speed_mps,
                closing_mps=closing,
            )
        )
    return tuple(sorted(found, key=lambda other: other.distance_m)[:NEAREST])


class _Voice:
    def __init__(self, loop: Samples, id_: float) -> None:
        self.needle = Needle(loop, (id_ * 0.381966) % 1.0)
        self.gains = np.zeros(CHANNELS, np.float32)


class Passing:
    """A voice for each road user that is heard: its tyres, by distance, direction and the Doppler effect."""

    def __init__(self, seed: int = 23) -> None:
        self._loop = noise_loop(seed, 120.0, 1_100.0, -3.0)
        self._voices: dict[float, _Voice] = {}

    def add(self, block: Samples, others: tuple[OtherHeard, ...]) -> None:
        """Add the next samples to `block`, float32 [samples, 6]; who is no longer heard fades in one block."""
        count = len(block)
        heard = {other.id: other for other in others}
        ramp = (np.arange(1, count + 1, dtype=np.float32) / count)[:, None]
        for id_ in [*heard, *(id_ for id_ in self._voices if id_ not in heard)]:
            voice = self._voices.setdefault(id_, _Voice(self._loop, id_))
            other = heard.get(id_)
            wanted = np.zeros(CHANNELS, np.float32)
            pitch = 1.0
            if other is not None:
                level = LEVEL * min(1.5, abs(other.speed_mps) / FULL_MPS) * NEAR_M / max(NEAR_M, other.distance_m)
                wanted = np.float32(level) * np.array(gains(other.bearing_rad), np.float32)
                pitch = 1.0 / (1.0 - max(-0.5, min(0.5, other.closing_mps / SOUND_MPS)))
            if voice.gains.any() or wanted.any():
                block += voice.needle.read(count, pitch)[:, None] * (voice.gains + (wanted - voice.gains) * ramp)
            voice.gains = wanted
            if other is None:
                del self._voices[id_]
