"""Parquet: float64 columns, compressed with zstd, each with its unit in its metadata."""

from pathlib import Path
from typing import Final

from pyarrow import parquet

from simconsole.recording.exports.arrow_batches import batches, schema
from simconsole.recording.exports.column_table import ColumnTable
from simconsole.recording.exports.drive_topics import OnTick

SUFFIX: Final = ".parquet"


def write_table(table: ColumnTable, path: Path, on_tick: OnTick) -> dict[str, int]:
    """Write a new file; return the number of its rows. Raises OSError."""
    rows = 0
    with parquet.ParquetWriter(path, schema(table), compression="zstd") as writer:
        for batch in batches(table, on_tick):
            writer.write_batch(batch)
            rows += batch.num_rows
    return {"rows": rows}
