"""What the autopilot reads of an odometry."""

import math

import msgspec
import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.drivers.autopilot.motion import Odometry, motion_of


def test_the_wanted_fields_say_what_the_whole_message_says() -> None:
    types = standard_registry().struct
    whole = types("nav_msgs/Odometry")()
    whole.header.stamp.sec, whole.header.stamp.nanosec = 3, 20_000_000
    whole.pose.pose.position.x, whole.pose.pose.position.y = 1.5, -2.5
    whole.pose.pose.orientation.z, whole.pose.pose.orientation.w = math.sin(0.3), math.cos(0.3)
    whole.twist.twist.linear.x, whole.twist.twist.linear.y, whole.twist.twist.angular.z = 8.0, 0.1, 0.2
    wanted = msgspec.json.decode(msgspec.json.encode(whole), type=Odometry)
    assert (wanted.header.stamp.sec, wanted.header.stamp.nanosec) == (3, 20_000_000)
    seen = motion_of(wanted)
    assert seen == motion_of(whole)
    assert seen is not None
    assert seen == pytest.approx((1.5, -2.5, 0.6, 8.0, 0.1, 0.2))


def test_a_value_that_is_not_finite_is_no_motion() -> None:
    odometry = standard_registry().struct("nav_msgs/Odometry")()
    odometry.twist.twist.linear.x = math.nan
    assert motion_of(odometry) is None
