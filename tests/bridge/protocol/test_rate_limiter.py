from simconsole.bridge.protocol.rate_limiter import Meter

MS = 1_000_000


def test_rate_is_held_over_a_second() -> None:
    meter = Meter(100.0)
    passed = sum(meter.allows(at * MS) for at in range(10_000))
    assert 100 + 990 <= passed <= 100 + 1000


def test_whoever_stays_below_it_never_notices() -> None:
    meter = Meter(100.0)
    assert all(meter.allows(10 * MS * number) for number in range(1000))


def test_as_many_as_in_a_second_may_come_at_once_and_again_after_one() -> None:
    meter = Meter(3.0)
    for now_ns in (0, 1000 * MS, 99_000 * MS):
        assert [meter.allows(now_ns) for _ in range(5)] == [True] * 3 + [False] * 2


def test_clock_that_steps_back_gives_nothing() -> None:
    meter = Meter(1.0)
    assert meter.allows(1000 * MS)
    assert not meter.allows(0)
    assert not meter.allows(0)


def test_no_rate_is_no_limit() -> None:
    assert all(Meter(None).allows(0) for _ in range(10))
