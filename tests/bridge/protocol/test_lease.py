from simconsole.bridge.protocol.lease import CommandDesk, Lease


def test_first_valid_command_starts_the_lease() -> None:
    lease = Lease(500)
    assert lease.holder(0) is None
    lease.renew(1, 100)
    assert lease.is_open_to(1, 200)
    assert not lease.is_open_to(2, 200)


def test_lease_ends_its_length_after_the_last_command() -> None:
    lease = Lease(500)
    lease.renew(1, 100)
    lease.renew(1, 400)
    assert lease.holder(899) == 1
    assert lease.holder(900) is None
    assert lease.is_open_to(2, 900)


def test_only_the_holder_can_release() -> None:
    lease = Lease(500)
    lease.renew(1, 100)
    assert not lease.release(2, 200)
    assert lease.release(1, 200)
    assert not lease.release(1, 200)
    assert lease.is_open_to(2, 200)


def test_release_after_the_end_is_no_loss() -> None:
    lease = Lease(500)
    lease.renew(1, 100)
    assert not lease.release(1, 700)


def test_a_desk_begins_with_nobody_and_tells_whom_it_was_given() -> None:
    told: list[str] = []
    desk = CommandDesk(500, lambda: told.append("refused"))
    assert desk.lease.holder(0) is None
    assert desk.lease.length_ns == 500
    desk.on_refused()
    desk.on_new_commander()
    desk.on_lost()
    assert told == ["refused"]
