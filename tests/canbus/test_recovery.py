from simconsole.canbus.recovery import Recovery, Seldom, error_label


def test_waits_double_from_one_to_thirty_seconds() -> None:
    recovery = Recovery(1.0, 30.0)
    now_s, waits = 100.0, []
    for _ in range(8):
        recovery.went_down("bus-off", now_s)
        due_s = now_s
        while not recovery.is_due(due_s):
            due_s += 0.5
        waits.append(due_s - now_s)
        now_s = due_s
    assert waits == [1, 2, 4, 8, 16, 30, 30, 30]
    assert recovery.downs == 1


def test_bus_that_falls_again_at_once_waits_longer_one_that_held_does_not() -> None:
    recovery = Recovery(1.0, 30.0)
    recovery.went_down("bus-off", 40.0)
    assert recovery.is_due(41.0)
    recovery.came_up(41.0)
    recovery.went_down("bus-off", 42.0)
    assert not recovery.is_due(43.9)
    recovery.came_up(44.0)
    recovery.went_down("bus-off", 74.0)
    assert recovery.is_due(75.0)
    assert recovery.downs == 3


def test_up_is_never_due() -> None:
    recovery = Recovery(1.0, 30.0)
    assert recovery.up
    assert not recovery.is_due(1e9)


def test_error_frames_are_told_in_words() -> None:
    assert error_label(0x40) == "bus-off"
    assert error_label(0x20 | 0x08) == "protocol violation, no acknowledgement"
    assert error_label(0x200) == "unspecified error"


def test_seldom_lets_one_through_and_then_waits() -> None:
    seldom = Seldom(10.0)
    assert [seldom(now_s) for now_s in (3.0, 4.0, 12.9, 13.0, 14.0)] == [True, False, False, True, False]
