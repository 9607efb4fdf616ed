import io

import numpy as np
import pytest

from simconsole.recording.framing import START_OF_CHAIN, Record, chain, frame_size, seal, seal_message
from simconsole.recording.log_header import LogHeader, encode_header
from simconsole.recording.scan import Scan
from simconsole.values.errors import RecordingError
from tests.recording.conftest import with_messages
from tests.samples import Sample


def scan(content: bytes) -> tuple[list[Record], Scan]:
    pass_ = Scan(io.BytesIO(content).read, "drive.log")
    return list(pass_), pass_


def test_a_whole_log_reads_back_bit_for_bit(header: LogHeader, rows: list[np.ndarray], log_bytes: bytes) -> None:
    records, pass_ = scan(log_bytes)
    assert pass_.header == header
    assert pass_.breaks == []
    assert [record.tick for record in records] == list(range(1, 41))
    assert all(record.vector.tobytes() == row.tobytes() for record, row in zip(records, rows, strict=True))


def test_the_hash_chains_over_every_row_before(log_bytes: bytes) -> None:
    digest = START_OF_CHAIN
    for record in scan(log_bytes)[0]:
        digest = chain(digest, record.tick, record.vector.tobytes())
        assert digest == record.digest


@pytest.mark.fault("P03")
@pytest.mark.fault("P04")
def test_truncation_at_every_byte_keeps_all_whole_ticks(header: LogHeader, log_bytes: bytes) -> None:
    start, size = len(encode_header(header)), frame_size(4)
    for length in range(len(log_bytes)):
        if length < start:
            with pytest.raises(RecordingError, match=r"^drive\.log: "):
                scan(log_bytes[:length])
            continue
        records, pass_ = scan(log_bytes[:length])
        whole, rest = divmod(length - start, size)
        assert [record.tick for record in records] == list(range(1, whole + 1))
        if rest == 0:
            assert pass_.breaks == []
        else:
            assert pass_.breaks[0].offset == start + whole * size
            assert str(pass_.breaks[0]).endswith(f"torn, {rest} of {size} bytes")


@pytest.mark.fault("P04")
def test_a_flipped_bit_loses_at_most_its_own_tick(header: LogHeader, log_bytes: bytes) -> None:
    start, size = len(encode_header(header)), frame_size(4)
    content = log_bytes[: start + 5 * size]
    for bit in range(8 * len(content)):
        damaged = bytearray(content)
        damaged[bit // 8] ^= 1 << bit % 8
        if bit // 8 < start:
            with pytest.raises(RecordingError, match=r"^drive\.log: "):
                scan(bytes(damaged))
            continue
        records, pass_ = scan(bytes(damaged))
        frame = (bit // 8 - start) // size
        assert [record.tick for record in records] == [tick for tick in range(1, 6) if tick != frame + 1]
        assert [part.offset for part in pass_.breaks] == [start + frame * size]


def test_garbage_between_two_ticks_is_one_break(header: LogHeader, log_bytes: bytes) -> None:
    start, size = len(encode_header(header)), frame_size(4)
    damaged = bytearray(log_bytes)
    damaged[start + 3 * size : start + 7 * size] = bytes(4 * size)
    records, pass_ = scan(bytes(damaged))
    assert len(records) == 36
    assert [(part.offset, part.size_bytes) for part in pass_.breaks] == [(start + 3 * size, 4 * size)]


def test_a_whole_tick_in_a_wrong_place_is_named(header: LogHeader, log_bytes: bytes) -> None:
    start, size = len(encode_header(header)), frame_size(4)
    records, pass_ = scan(log_bytes[: start + size] + log_bytes[start + 2 * size : start + 3 * size])
    assert [record.tick for record in records] == [1]
    assert pass_.breaks[0].reason == "tick 3 where tick 2 belongs"


def sizes_of(content: bytes, header: LogHeader) -> list[int]:
    """Return where each frame of a whole log begins, and where the last one ends."""
    at = [len(encode_header(header))]
    while at[-1] < len(content):
        at.append(at[-1] + 8 + int.from_bytes(content[at[-1] : at[-1] + 4], "little"))
    return at


def contents(records: list[Record]) -> dict[int, tuple[bytes, ...]]:
    return {record.tick: tuple(part.content for part in record.messages) for record in records if record.messages}


def test_messages_read_back_in_their_ticks(
    rows: list[np.ndarray], log_with_acts: bytes, acts: dict[int, tuple[bytes, ...]]
) -> None:
    records, pass_ = scan(log_with_acts)
    assert pass_.breaks == []
    assert contents(records) == acts
    assert all(record.vector.tobytes() == row.tobytes() for record, row in zip(records, rows, strict=True))


@pytest.mark.fault("P03")
@pytest.mark.fault("P04")
def test_truncation_in_the_last_frames_with_messages_keeps_all_whole_ticks(
    header: LogHeader, log_with_acts: bytes
) -> None:
    at = sizes_of(log_with_acts, with_messages(header))
    for length in range(at[-4], len(log_with_acts)):
        records, pass_ = scan(log_with_acts[:length])
        whole = sum(end <= length for end in at[1:])
        assert [record.tick for record in records] == list(range(1, whole + 1))
        rest = length - at[whole]
        assert [(part.offset, part.size_bytes, part.torn) for part in pass_.breaks] == (
            [(at[whole], rest, True)] if rest else []
        )


@pytest.mark.fault("P04")
def test_a_flipped_bit_in_a_frame_with_messages_loses_at_most_its_own_tick(
    header: LogHeader, log_with_acts: bytes
) -> None:
    at = sizes_of(log_with_acts, with_messages(header))
    for frame in (0, 2, 3, 19, 38, 39):
        for byte in range(at[frame], at[frame + 1]):
            damaged = bytearray(log_with_acts)
            damaged[byte] ^= 1 << byte % 8
            records, pass_ = scan(bytes(damaged))
            assert [record.tick for record in records] == [tick for tick in range(1, 41) if tick != frame + 1]
            found = [(part.offset, part.size_bytes, part.torn) for part in pass_.breaks]
            assert found == [(at[frame], at[frame + 1] - at[frame], False)]


@pytest.mark.fault("P04")
@pytest.mark.parametrize("change", [-700, -41, -1, 1, 41, 3000, 2 << 20])
def test_reading_goes_on_behind_bytes_that_are_gone_or_too_many(
    header: LogHeader, log_with_acts: bytes, change: int
) -> None:
    at = sizes_of(log_with_acts, with_messages(header))
    first, middle = log_with_acts[: at[10] + 5], log_with_acts[at[10] + 5 :]
    content = first + (middle[-change:] if change < 0 else b"\x7f" * change + middle)
    records, pass_ = scan(content)
    lost = max(1, sum(end - at[10] - 5 < -change for end in at[11:]) + 1)
    assert [record.tick for record in records] == [*range(1, 11), *range(11 + lost, 41)]
    assert [part.torn for part in pass_.breaks] == [False]


@pytest.mark.fault("P04")
def test_a_tick_written_into_a_message_is_not_taken_for_one(header: LogHeader, rows: list[np.ndarray]) -> None:
    """A message may hold anything, the bytes of a frame too: only its own frame's damage brings them up."""
    inner, _ = seal(START_OF_CHAIN, 2, rows[1].tobytes())
    message, _ = seal_message(START_OF_CHAIN, 1, 1, inner)
    outer, digest = seal(START_OF_CHAIN, 1, rows[0].tobytes(), message)
    follows, _ = seal(digest, 2, rows[1].tobytes())
    records, pass_ = scan(encode_header(with_messages(header)) + outer + follows)
    assert [record.tick for record in records] == [1, 2]
    assert pass_.breaks == []


@pytest.mark.fault("P04")
def test_random_damage_loses_only_what_it_hit(header: LogHeader, log_with_acts: bytes, sample: Sample) -> None:
    """A run of random bytes anywhere: every tick that it did not touch reads back, bit for bit."""
    generator = np.random.default_rng(sample.seed)
    at = sizes_of(log_with_acts, with_messages(header))
    whole = {record.tick: record for record in scan(log_with_acts)[0]}
    for _ in range(sample.of(2_000, 20_000)):
        damaged = bytearray(log_with_acts)
        start = int(generator.integers(at[0], len(damaged)))
        end = min(start + int(generator.integers(1, 600)), len(damaged))
        damaged[start:end] = generator.bytes(end - start)
        records, pass_ = scan(bytes(damaged))
        hit = [n for n in range(40) if damaged[at[n] : at[n + 1]] != log_with_acts[at[n] : at[n + 1]]]
        assert [record.tick for record in records] == [tick for tick in range(1, 41) if tick - 1 not in hit]
        assert all(contents([record]) == contents([whole[record.tick]]) for record in records)
        assert sum(part.size_bytes for part in pass_.breaks) == sum(at[n + 1] - at[n] for n in hit)
        assert not any(part.torn for part in pass_.breaks)


def test_random_bytes_never_raise_anything_else(header: LogHeader, log_bytes: bytes) -> None:
    seed = 20261120
    print("seed", seed)
    generator = np.random.default_rng(seed)
    start = len(encode_header(header))
    for _ in range(300):
        damaged = bytearray(log_bytes)
        for at in generator.integers(start, len(damaged), generator.integers(1, 40)):
            damaged[at] = generator.integers(256)
        cut = int(generator.integers(start, len(damaged) + 1))
        records, _ = scan(bytes(damaged[:cut]))
        ticks = [record.tick for record in records]
        assert ticks == sorted(set(ticks))
