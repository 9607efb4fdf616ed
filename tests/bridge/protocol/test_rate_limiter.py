from simconsole.bridge.protocol.rate_limiter import ByteMeter, RateLimiter

MS = 1_000_000


def test_rate_is_held_over_a_second() -> None:
    rate_limiter = RateLimiter(100.0)
    passed = sum(rate_limiter.allows(at * MS) for at in range(10_000))
    assert 100 + 990 <= passed <= 100 + 1000


def test_whoever_stays_below_it_never_notices() -> None:
    rate_limiter = RateLimiter(100.0)
    assert all(rate_limiter.allows(10 * MS * number) for number in range(1000))


def test_as_many_as_in_a_second_may_come_at_once_and_again_after_one() -> None:
    rate_limiter = RateLimiter(3.0)
    for now_ns in (0, 1000 * MS, 99_000 * MS):
        assert [rate_limiter.allows(now_ns) for _ in range(5)] == [True] * 3 + [False] * 2


def test_clock_that_steps_back_gives_nothing() -> None:
    rate_limiter = RateLimiter(1.0)
    assert rate_limiter.allows(1000 * MS)
    assert not rate_limiter.allows(0)
    assert not rate_limiter.allows(0)


def test_no_rate_is_no_limit() -> None:
    assert all(RateLimiter(None).allows(0) for _ in range(10))


def test_work_beyond_a_second_s_worth_is_paid_off_by_waiting() -> None:
    meter = ByteMeter(1000.0)
    meter.charge(1000, 0)
    assert meter.ready_ns == 0
    meter.charge(500, 0)
    assert meter.ready_ns == 500 * MS
    meter.charge(500, 500 * MS)
    assert meter.ready_ns == 1000 * MS


def test_silence_saves_up_no_more_than_a_second_s_worth() -> None:
    meter = ByteMeter(1000.0)
    meter.charge(2500, 1_000_000 * MS)
    assert meter.ready_ns == 1_001_500 * MS
