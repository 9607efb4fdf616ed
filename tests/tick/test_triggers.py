from typing import NamedTuple

import numpy as np
import pytest

from simconsole.profiles.faults import Place, Trigger
from simconsole.tick.triggers import TriggerWatch, WatchedVehicle, own_vehicle
from simconsole.values.signals import FAR, Button, Event, Mode
from simconsole.values.state_vector import Snapshot, columns

TICK_HZ = 100
FREE = WatchedVehicle(x_m=0.0, y_m=0.0, distance_m=0.0, speed_mps=0.0, gap_m=FAR, closing_mps=0.0)


class Nothing(NamedTuple):
    nothing: float


NAMES = columns(Nothing)


def snapshot(tick: int = 1, **values: float) -> Snapshot:
    row = np.zeros(len(NAMES))
    row[NAMES.index("ahead.lead_gap_m")] = FAR
    for name, value in values.items():
        row[NAMES.index(name.replace("__", "."))] = value
    return Snapshot(tick, TICK_HZ, row)


@pytest.mark.parametrize(
    ("trigger", "before", "after"),
    [
        (Trigger(at_distance_m=5.0), FREE, FREE._replace(distance_m=5.0)),
        (Trigger(near=Place(x_m=3.0, y_m=4.0, radius_m=1.0)), FREE, FREE._replace(x_m=3.0, y_m=3.0)),
        (Trigger(above_mps=5.0), FREE._replace(speed_mps=5.0), FREE._replace(speed_mps=5.1)),
        (Trigger(below_mps=5.0), FREE._replace(speed_mps=5.0), FREE._replace(speed_mps=4.9)),
        (Trigger(gap_below_m=10.0), FREE._replace(gap_m=10.0), FREE._replace(gap_m=9.9)),
        (
            Trigger(headway_below_s=2.0),
            FREE._replace(gap_m=20.0, speed_mps=10.0),
            FREE._replace(gap_m=19.0, speed_mps=10.0),
        ),
        (
            Trigger(collision_below_s=2.0),
            FREE._replace(gap_m=20.0, speed_mps=30.0, closing_mps=9.0),
            FREE._replace(gap_m=20.0, speed_mps=30.0, closing_mps=11.0),
        ),
    ],
)
def test_a_trigger_comes_when_its_limit_is_passed_and_stays(
    trigger: Trigger, before: WatchedVehicle, after: WatchedVehicle
) -> None:
    watch = TriggerWatch(trigger, TICK_HZ)
    assert watch.turn(2, snapshot(1), before) is None
    assert watch.turn(3, snapshot(2), after) == 3
    assert watch.turn(4, snapshot(3), before) == 3


def test_a_speed_is_not_fallen_below_before_it_was_driven() -> None:
    watch = TriggerWatch(Trigger(below_mps=5.0), TICK_HZ)
    assert watch.turn(2, snapshot(1), FREE) is None
    assert watch.turn(3, snapshot(2), FREE._replace(speed_mps=6.0)) is None
    assert watch.turn(4, snapshot(3), FREE) == 4


def test_what_must_rise_is_seen_not_to_be_so_first() -> None:
    fast, slow = FREE._replace(speed_mps=6.0), FREE._replace(speed_mps=4.0)
    watch = TriggerWatch(Trigger(above_mps=5.0), TICK_HZ, rising=True)
    looks = [watch.turn(tick, snapshot(tick - 1), seen) for tick, seen in enumerate([fast, fast, slow, fast, slow], 1)]
    assert looks == [None, None, None, 4, 4]
    assert TriggerWatch(Trigger(above_mps=5.0), TICK_HZ).turn(1, snapshot(0), fast) == 1


def test_times_are_known_before_they_come_and_delays_are_added() -> None:
    assert TriggerWatch(Trigger(at_s=0.5, delay_s=0.1), TICK_HZ).turn(1, snapshot(0)) == 60
    assert TriggerWatch(Trigger(above_mps=0.0, delay_s=0.1), TICK_HZ).turn(7, snapshot(6, vehicle__vx_mps=-1.0)) == 17


def test_modes_edges_and_the_button() -> None:
    mode = TriggerWatch(Trigger(on_mode="autonomous"), TICK_HZ)
    assert mode.turn(2, snapshot(1)) is None
    assert mode.turn(3, snapshot(2, arbitration__mode=float(Mode.AUTONOMOUS))) == 3
    edge = TriggerWatch(Trigger(on_event="collision"), TICK_HZ)
    assert edge.turn(3, snapshot(2, events__events=float(Event.COLLISION | Event.MARK))) == 3
    button = TriggerWatch(Trigger(on_event="fault"), TICK_HZ)
    assert button.turn(3, snapshot(2, driver__edges=float(Button.FAULT))) == 3


def test_the_consoles_vehicle_is_seen_with_its_gap() -> None:
    row = {"vehicle__vx_mps": 10.0, "vehicle__x_m": 3.0, "ahead__lead_gap_m": 25.0, "ahead__lead_speed_mps": 4.0}
    assert own_vehicle(snapshot(1, **row)) == WatchedVehicle(3.0, 0.0, 0.0, 10.0, 25.0, 6.0)
    watch = TriggerWatch(Trigger(gap_below_m=26.0), TICK_HZ)
    assert watch.turn(2, snapshot(1)) is None, "nobody is ahead"
    assert watch.turn(3, snapshot(2, **row)) == 3
