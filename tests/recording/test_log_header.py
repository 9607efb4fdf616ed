import io
import struct
import sys
from zlib import crc32

import msgspec
import pytest

from simconsole.recording.log_header import (
    MAGIC,
    SCHEMA,
    LogHeader,
    encode_header,
    message_stream,
    read_header,
    stream_index,
    vector_stream,
)
from simconsole.values.errors import RecordingError
from tests.recording.conftest import COLUMNS, with_messages

STATE = {"name": "state", "kind": "vectors", "columns": COLUMNS, "units": ["1", "1", "1", "m/s"], "input_columns": 2}
ACTS = {"name": "acts", "kind": "messages", "encoding": "json"}


def scan(content: bytes) -> LogHeader:
    return read_header(io.BytesIO(content).read, "drive.log")[0]


def with_header(content: bytes, **changes: object) -> bytes:
    size = struct.unpack_from("<I", content, len(MAGIC))[0]
    raw = {**msgspec.json.decode(content[16 : 16 + size]), **changes}
    text = msgspec.json.encode(raw)
    return MAGIC + struct.pack("<II", len(text), crc32(text)) + text + content[16 + size :]


def test_a_header_reads_back_with_its_streams_and_bytes(header: LogHeader) -> None:
    written = encode_header(with_messages(header))
    found, start = read_header(io.BytesIO(written + b"ticks").read, "drive.log")
    assert (found, start) == (with_messages(header), written)
    assert found.columns == COLUMNS
    assert found.input_columns == 2
    assert [stream.name for stream in found.streams] == ["state", "acts", "scans"]
    assert found.streams[0].units == ("1", "1", "1", "m/s")
    assert found.streams[1:] == (message_stream("acts"), message_stream("scans", ""))


def test_a_stream_is_found_by_its_name(header: LogHeader) -> None:
    assert stream_index(with_messages(header), "acts") == 1
    with pytest.raises(RecordingError, match="no stream 'notes', only state, acts, scans"):
        stream_index(with_messages(header), "notes")


def of_first_schema(**changes: object) -> bytes:
    raw = {
        "tick_hz": 250,
        "columns": COLUMNS,
        "input_columns": 2,
        "console_version": "0",
        "source_sha256": "aa",
        "session_sha256": "bb",
        "schema": 1,
        "byte_order": sys.byteorder,
        "values": "float64",
        **changes,
    }
    text = msgspec.json.encode(raw)
    return MAGIC + struct.pack("<II", len(text), crc32(text)) + text


def test_a_log_of_the_first_schema_has_one_stream(header: LogHeader) -> None:
    assert scan(of_first_schema()) == header == msgspec.structs.replace(header, streams=(vector_stream(COLUMNS, 2),))
    with pytest.raises(RecordingError, match="input_columns: 5 is outside 0 to 4"):
        scan(of_first_schema(input_columns=5))
    with pytest.raises(RecordingError, match="columns"):
        scan(of_first_schema(columns=None))
    with pytest.raises(RecordingError, match="streams"):
        scan(of_first_schema(streams=[]))


@pytest.mark.fault("F05")
def test_f05_newer_schema_is_refused(log_bytes: bytes) -> None:
    newer = with_header(log_bytes, schema=SCHEMA + 1, a_key_of_tomorrow=1)
    with pytest.raises(RecordingError, match=rf"^drive\.log: schema: {SCHEMA + 1} .* reads 1 to {SCHEMA}$"):
        scan(newer)


@pytest.mark.fault("F05")
def test_f05_another_byte_order_is_refused(log_bytes: bytes) -> None:
    other = "big" if sys.byteorder == "little" else "little"
    with pytest.raises(RecordingError, match=f"byte_order: '{other}' cannot be read here"):
        scan(with_header(log_bytes, byte_order=other))


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"schema": "1"}, "schema"),
        ({"schema": 0}, "schema"),
        ({"tick_hz": 0}, "tick_hz"),
        ({"tick_hz": 1001}, "tick_hz"),
        ({"tick_hz": "250"}, "tick_hz"),
        ({"streams": None}, "streams"),
        ({"streams": []}, "one of vectors"),
        ({"streams": [ACTS]}, "one of vectors"),
        ({"streams": [STATE, {**STATE, "name": "other"}]}, "one of vectors"),
        ({"streams": [STATE, {**ACTS, "name": "state"}]}, "streams: name"),
        ({"streams": [{**STATE, "kind": "rows"}]}, "kind"),
        ({"streams": [{**STATE, "units": ["m"]}]}, "units: 1 for 4 columns"),
        ({"streams": [{**STATE, "input_columns": 5}]}, "input_columns: 5"),
        ({"streams": [{**STATE, "input_columns": -1}]}, "input_columns: -1"),
        ({"values": "float32"}, "values"),
        ({"unheard_of": 1}, "unheard_of"),
    ],
)
def test_a_bad_header_names_file_and_key(log_bytes: bytes, changes: dict[str, object], named: str) -> None:
    with pytest.raises(RecordingError, match=named) as caught:
        scan(with_header(log_bytes, **changes))
    assert str(caught.value).startswith("drive.log: ")
    assert "\n" not in str(caught.value)
    assert caught.value.exit_code == 2


@pytest.mark.parametrize("text", [b"[]", b"{", b"\xff\xfe", b'{"schema": true}', b"[" * 100_000])
def test_a_header_that_is_not_ours_is_refused(text: bytes) -> None:
    with pytest.raises(RecordingError, match=r"^drive\.log: "):
        scan(MAGIC + struct.pack("<II", len(text), crc32(text)) + text)


def test_a_header_of_two_gigabytes_is_not_read() -> None:
    with pytest.raises(RecordingError, match="allowed up to"):
        scan(MAGIC + struct.pack("<II", 1 << 31, 0))
