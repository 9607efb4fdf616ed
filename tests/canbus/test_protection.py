import random

import pytest

from simconsole.canbus.protection import Check, Receiver, checksum, crc8, protected

ID = 0x200
TIMEOUT_NS = 200_000_000
STEP_NS = 20_000_000


def frame(counter: int, can_id: int = ID) -> bytes:
    return protected(can_id, bytes(8), counter)


def receiver(**limits: int) -> Receiver:
    return Receiver(ID, TIMEOUT_NS, **limits)


def synchronised(counter: int = 0) -> Receiver:
    found = receiver()
    assert found.take(frame(counter - 1), 0) is Check.NO_NEW_DATA
    assert found.take(frame(counter), 0) is Check.OK
    return found


def test_crc_is_that_of_sae_j1850() -> None:
    """Check values of AUTOSAR's specification of CRC routines, CRC8."""
    assert crc8(b"123456789") == 0x4B
    assert crc8(bytes(4)) == 0x59
    assert crc8(bytes.fromhex("F20183")) == 0x37
    assert crc8(bytes.fromhex("0FAA0055")) == 0x79
    assert crc8(bytes.fromhex("00FF5511")) == 0xB8


def test_checksum_covers_id_and_all_bytes_but_itself() -> None:
    data = bytes(range(8))
    assert checksum(0x321, data) == crc8(bytes((0x21, 0x03)) + data[1:])
    assert checksum(0x321, bytes((99,)) + data[1:]) == checksum(0x321, data)


def test_protected_keeps_everything_but_crc_and_counter() -> None:
    data = protected(ID, bytes.fromhex("FFA5010203040506"), 0x1C)
    assert data[1:] == bytes.fromhex("AC010203040506")
    assert data[0] == checksum(ID, data)


def test_every_single_and_double_bit_error_is_found() -> None:
    good = int.from_bytes(frame(5), "big")
    for first in range(64):
        for second in range(first, 64):
            flipped = good ^ (1 << first) ^ ((1 << second) if second != first else 0)
            data = flipped.to_bytes(8, "big")
            assert data[0] != checksum(ID, data), (first, second)


def test_frame_of_another_id_is_refused() -> None:
    assert synchronised().take(frame(1, can_id=0x201), 0) is Check.WRONG_CRC


def test_first_frame_only_tells_the_counter() -> None:
    watched = receiver()
    assert watched.take(frame(7), 0) is Check.NO_NEW_DATA
    assert watched.take(frame(8), STEP_NS) is Check.OK
    assert (watched.refused, watched.lost) == (0, 0)


def test_frames_in_sequence_are_ok_across_the_counters_end() -> None:
    watched = synchronised(13)
    for index, counter in enumerate((14, 15, 0, 1), 1):
        assert watched.take(frame(counter), index * STEP_NS) is Check.OK


@pytest.mark.parametrize(
    ("step", "state"),
    [(0, Check.REPEATED), (1, Check.OK), (2, Check.OK)] + [(step, Check.WRONG_SEQUENCE) for step in range(3, 16)],
)
def test_step_of_the_counter(step: int, state: Check) -> None:
    watched = synchronised(4)
    assert watched.take(frame(4 + step), STEP_NS) is state
    assert watched.lost == (1 if step == 2 else 0)
    assert watched.refused == (0 if state is Check.OK else 1)


def test_wrong_frame_does_not_move_the_sequence() -> None:
    watched = synchronised(4)
    assert watched.take(frame(11), 1) is Check.WRONG_SEQUENCE
    assert watched.take(frame(5), 2) is Check.OK


@pytest.mark.parametrize("length", [0, 1, 7, 9, 64])
def test_wrong_length(length: int) -> None:
    assert synchronised().take(bytes(length), 1) is Check.WRONG_LENGTH


def test_silence_is_no_new_data_from_the_time_out_on() -> None:
    watched = synchronised()
    assert watched.look(TIMEOUT_NS - 1) is Check.OK
    assert watched.look(TIMEOUT_NS) is Check.NO_NEW_DATA
    assert watched.take(frame(1), TIMEOUT_NS) is Check.NO_NEW_DATA
    assert watched.take(frame(2), TIMEOUT_NS + 1) is Check.OK


def test_bad_frames_do_not_put_the_time_out_off() -> None:
    watched = synchronised()
    for step in range(1, 10):
        watched.take(bytes(8), step * STEP_NS)
    assert watched.look(TIMEOUT_NS) is Check.NO_NEW_DATA


def test_restarted_sender_is_heard_after_five_bad_frames() -> None:
    watched = synchronised(9)
    states = [watched.take(frame(counter), counter * STEP_NS) for counter in range(6)]
    assert states == [Check.WRONG_SEQUENCE] * 5 + [Check.OK]


def test_random_frames_are_never_ok() -> None:
    """A CRC of 8 bits lets 1 in 256 pass, a counter step of 2 in 16 of those; a whole sequence none."""
    seed = 20261121
    noise = random.Random(seed)
    watched = synchronised()
    passed = sum(watched.take(noise.randbytes(8), step) is Check.OK for step in range(20_000))
    assert passed < 20_000 / 256 / 16 * 2 * 2, f"seed {seed}"
