import pytest

from simconsole.bridge.protocol.backoff import CAP_S, Backoff, Liveness


def test_pauses_double_up_to_the_cap_and_begin_again() -> None:
    backoff = Backoff(0.1, 0.5)
    assert [backoff.pause_s(0.5) for _ in range(5)] == pytest.approx([0.1, 0.2, 0.4, 0.5, 0.5])
    backoff.reset()
    assert backoff.pause_s(0.5) == pytest.approx(0.1)


def test_pauses_are_scattered_but_stay_below_two_seconds() -> None:
    assert Backoff(1.0, 9.0).pause_s(0.0) == pytest.approx(0.75)
    backoff = Backoff()
    assert max(backoff.pause_s(1.0) for _ in range(20)) == pytest.approx(1.25 * CAP_S)
    assert 1.25 * CAP_S < 2.0


def test_silence_is_asked_about_each_second_and_ends_after_three() -> None:
    liveness = Liveness()
    liveness.begin(10.0)
    assert liveness.patience_s(10.25) == 0.75
    assert not liveness.ping_due(10.9)
    assert liveness.ping_due(11.0)
    assert not liveness.ping_due(11.5)
    assert liveness.ping_due(12.0)
    assert liveness.patience_s(12.5) == 0.5
    assert not liveness.is_dead(12.99)
    assert liveness.silence_s(12.99) == pytest.approx(2.99)
    assert liveness.is_dead(13.0)
    liveness.heard(12.99)
    liveness.heard(5.0)
    assert not liveness.is_dead(15.0)
    assert liveness.patience_s(99.0) == 0.0
    assert liveness.ping_due(99.0)
    assert liveness.patience_s(99.25) == 0.75, "whoever waits on is not woken until the next ping"


def test_silence_counts_only_while_somebody_listens() -> None:
    liveness = Liveness()
    liveness.begin(10.0)
    liveness.look(11.5)
    liveness.look(13.0)
    assert liveness.is_dead(13.0)
    liveness.listen(60.0)
    liveness.look(61.0)
    assert liveness.is_dead(61.0), "nobody looked for a while, but all that came is read by now"
    liveness.look(62.75)
    assert not liveness.is_dead(65.5)
    assert liveness.is_dead(65.75)
