import json
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq

from simconsole.recording.bundles.packed_writer import METADATA_KEY, PackedLogWriter
from simconsole.recording.framing import Record, SealedMessage
from simconsole.recording.log_header import LogHeader, encode_header
from simconsole.recording.packing import Coded, Constant, Plain, Rule
from tests.bits import difference
from tests.recording.conftest import COLUMNS, with_messages

RULES: dict[str, Rule] = dict(zip(COLUMNS, (Plain(), Constant(0), Coded(1), Plain()), strict=True))
ROWS = np.array([[1.5, 0.0, 3.0, np.nan], [-0.0, 0.0, 4.0, 5.0]])


def test_any_program_reads_plain_columns_with_their_units(tmp_path: Path, header: LogHeader) -> None:
    path = tmp_path / "drive.parquet"
    with PackedLogWriter(path, header, b"", RULES) as writer:
        writer.append([Record(7, ROWS[0], bytes(8)), Record(8, ROWS[1], bytes(8))])
    table = pq.read_table(path)
    assert table.column_names == ["tick", "sample.brake_axis", "driver.brake", "vehicle.vx_mps"]
    assert table.column("tick").to_pylist() == [7, 8]
    assert not difference(table.column("vehicle.vx_mps").to_numpy(), ROWS[:, 3])
    assert table.schema.field("vehicle.vx_mps").metadata[b"unit"] == b"m/s"
    assert table.schema.field("driver.brake").type == "int64"


def test_messages_stand_in_the_row_of_their_tick(tmp_path: Path, header: LogHeader) -> None:
    path, wide = tmp_path / "drive.parquet", with_messages(header)
    messages = (SealedMessage(2, b"\x00\xff", b"22222222"), SealedMessage(1, b"{}", b"11111111"))
    with PackedLogWriter(path, wide, encode_header(wide), RULES) as writer:
        writer.append([Record(1, ROWS[0], b"aaaaaaaa", messages), Record(2, ROWS[1], b"bbbbbbbb")])
        writer.append([Record(3, ROWS[1], b"cccccccc")])
    found = pq.read_table(path).column("messages").to_pylist()
    assert found == [[{"stream": "scans", "content": b"\x00\xff"}, {"stream": "acts", "content": b"{}"}], [], []]
    stated = json.loads(pq.read_metadata(path).metadata[METADATA_KEY])
    assert stated["digests"] == [
        [text.hex() for text in group]
        for group in ((b"bbbbbbbb", b"11111111", b"22222222"), (b"cccccccc", b"11111111", b"22222222"))
    ]
