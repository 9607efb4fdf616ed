from simconsole.bridge.link.measurements import LateMeasurements
from simconsole.profiles.link import LinkProfile, WayProfile

TICK_HZ = 250


def told(way: WayProfile, ticks: int, topics: tuple[str, ...] = ("/odom",)) -> list[tuple[int, str, int]]:
    """Send each topic in every fifth tick; return (tick of arrival, topic, tick that it tells of), as they come."""
    late: LateMeasurements[tuple[str, int]] = LateMeasurements(LinkProfile(seed=5, measurements=way))
    seen = []
    for tick in range(1, ticks):
        if tick % 5 == 0:
            for topic in topics:
                late.send(topic, tick, TICK_HZ, (topic, tick))
        seen += [(tick, *one) for one in late.arrived(tick)]
    return seen


def test_all_come_after_the_delay_in_the_order_of_the_table() -> None:
    seen = told(WayProfile(delay_ms=12.0), 100, ("/tf", "/odom"))
    assert seen == [(tick + 3, topic, tick) for tick in range(5, 97, 5) for topic in ("/tf", "/odom")]


def test_what_jitters_is_overtaken() -> None:
    seen = told(WayProfile(jitter_ms=100.0), 5000)
    stamps = [tick for _, _, tick in seen]
    assert stamps != sorted(stamps)
    assert len(set(stamps)) == len(stamps) > 980, "but nothing is lost, or told twice"
    assert all(tick <= arrival <= tick + 25 for arrival, _, tick in seen)


def test_topics_are_lost_independently() -> None:
    seen = told(WayProfile(loss_share=0.5), 20_000, ("/tf", "/odom"))
    lost = {topic: {tick for _, name, tick in seen if name == topic} for topic in ("/tf", "/odom")}
    for ticks in lost.values():
        assert abs(len(ticks) / 3999 - 0.5) < 0.04
    assert abs(len(lost["/tf"] & lost["/odom"]) / 3999 - 0.25) < 0.04
