import numpy as np
import pytest

from simconsole.world import traffic_columns as at
from simconsole.world.roads.road_map import Array
from simconsole.world.traffic.courtesy import KEPT_S, SETS_OFF_S, WAITED_S, Courtesy
from simconsole.world.traffic.junctions import GIVE_WAY, GO, STOP
from simconsole.world.traffic.network import network
from tests.world.nets import straight_map


def watched(light: int) -> tuple[Courtesy, Array, "np.ndarray[tuple[int, ...], np.dtype[np.int64]]"]:
    net = network(straight_map())
    lights = np.full(len(net.goals), light, np.int64)
    kept_free = np.zeros(len(net.goals), np.int64)
    box = np.zeros(at.BOX)
    box[[at.LENGTH, at.LANE, at.ALONG]] = 4.0, net.origins[0], net.lengths_m[net.origins[0]] - 3.5
    return Courtesy(net, lights, kept_free), box, kept_free


def kept_after(time_s: float, light: int, speed_mps: float = 0.0) -> bool:
    courtesy, box, kept_free = watched(light)
    box[at.SPEED] = speed_mps
    for _ in range(round(time_s / 0.1)):
        courtesy.step(box.tolist(), 0.1)
    return bool(kept_free.any())


@pytest.mark.parametrize(
    ("time_s", "light", "kept"),
    [
        (WAITED_S - 1.0, GIVE_WAY, False),
        (WAITED_S + 1.0, GIVE_WAY, True),
        (WAITED_S + KEPT_S + 1.0, GIVE_WAY, False),  # who does not drive on is not waited for
        (WAITED_S + 1.0, STOP, False),
        (1.0, GO, True),
        (SETS_OFF_S + 1.0, GO, False),
    ],
)
def test_who_waits_long_is_let_in_for_a_while(time_s: float, light: int, kept: bool) -> None:
    assert kept_after(time_s, light) == kept


def test_who_drives_waits_for_nobody() -> None:
    assert not kept_after(WAITED_S + 1.0, GIVE_WAY, 5.0)
