"""Eight clients and nodes at random: the bridge lives, every call ends, and nothing is left over."""

from collections.abc import Callable
from random import Random

import pytest

from tests.interop.programs import client
from tests.interop.puppets import puppet, served
from tests.interop.relay_walk import Walker, endpoints, known, node_step, wait_for_all
from tests.interop.ros2 import domain, needs_ros2
from tests.patience import pause, wait_until
from tests.samples import Sample

pytestmark = needs_ros2

PERIOD_S = 0.003
SETTLED = 500
"""Operations after which every call is waited for."""


@pytest.mark.timeout(7200)
def test_walk(sample: Sample, record_property: Callable[[str, object], None]) -> None:
    random = Random(sample.seed)
    steps = sample.of(150, 100_000)
    around = domain()
    with (
        served(around) as console,
        puppet(around, "one") as one,
        puppet(around, "two") as two,
        puppet(around, "three") as three,
    ):
        nodes = [one, two, three]
        walkers = [Walker(console.url, Random(random.random())) for _ in range(5)]
        with client(console.url) as witness:
            for number in range(steps):
                if random.random() < 0.7:
                    random.choice(walkers).step()
                else:
                    node_step(random.choice(nodes), random)
                pause(PERIOD_S)
                if number % SETTLED == SETTLED - 1:
                    wait_for_all(walkers)
            wait_for_all(walkers)
            for walker in walkers:
                assert walker.unexpected == []
                walker.close()
            witness.say(op="call_service", id="alive", service="/rosapi/get_time")
            assert witness.hear(lambda heard: heard.get("id") == "alive")["result"] is True
        sent = sum(walker.sent for walker in walkers)
        record_property("relay walk", f"{steps} operations, {sent} calls and goals of clients")
        for node in (two, three):
            assert node.process.poll() is None
            node.process.kill()
        one.do("destroy_all")
        wait_until(lambda: not any(endpoints(one).values()), "an end of all that the console had for the walk")
        with client(console.url) as witness:
            wait_until(lambda: not known(witness), "an end of all that the console knew of the walk")
