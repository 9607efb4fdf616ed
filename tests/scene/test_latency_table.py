from simconsole.scene.latency_table import latency_table
from simconsole.values.latency import Hop, LatencyStatistics
from tests.values.test_latency import Clock


def test_each_hop_has_a_line_in_its_order() -> None:
    clock = Clock({})
    statistics = LatencyStatistics(clock.read)
    statistics.add(Hop.STEP, 120_000)
    statistics.add(Hop.READ, 40_000)
    lines = latency_table(statistics.summary_us()).splitlines()
    assert [line.split("|")[1].strip() for line in lines] == ["hop", "---", "read", "step"]
    assert lines[-1] == "| step | 120 | 120 | 120 | 1 |"
