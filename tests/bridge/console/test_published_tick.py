"""What the messages of one tick share."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from simconsole.bridge.console.published_tick import MAP_FRAME, PublishedTick, quaternion
from simconsole.bridge.link.localisation import Localisation
from simconsole.bridge.messages import standard_registry
from simconsole.profiles.link import LinkProfile, LocalisationProfile


def test_a_tick_is_measured_once_and_its_orientation_is_made_once(snapshot: Callable[..., Any]) -> None:
    types = [standard_registry().struct(name) for name in _TYPES]
    link = LinkProfile(localisation=LocalisationProfile(position_noise_m=0.5))
    tick = PublishedTick(snapshot(375, yaw_rad=1.0), Localisation(link), *types)
    assert (tick.stamp.sec, tick.stamp.nanosec) == (1, 500_000_000)
    assert (tick.header(MAP_FRAME).stamp, tick.header(MAP_FRAME).frame_id) == (tick.stamp, "map")
    assert tick.measured is tick.measured
    assert tick.measured.x_m != tick.vehicle.x_m
    assert tick.orientation(tick.measured) is tick.orientation(tick.measured)
    assert tick.orientation(tick.vehicle).z == pytest.approx(math.sin(0.5))


def test_quaternion_turns_about_z() -> None:
    assert quaternion(0.0, 0.0, math.pi) == pytest.approx((0.0, 0.0, 1.0, 0.0), abs=1e-12)


_TYPES = ("builtin_interfaces/Time", "std_msgs/Header", "geometry_msgs/Quaternion")
