"""A table of a drive in Arrow's form, which CSV and Parquet are written from."""

from collections.abc import Iterator
from typing import Any, Final

import pyarrow

from simconsole.recording.exports.column_table import ColumnTable
from simconsole.recording.exports.drive_topics import OnTick

UNIT: Final = b"unit"
"""Key of a field's metadata that holds its unit."""
_TYPES: Final = {int: pyarrow.int64(), float: pyarrow.float64(), str: pyarrow.string()}


def schema(table: ColumnTable) -> Any:
    """Return the Arrow schema of a table, with each column's unit in its field's metadata."""
    return pyarrow.schema(
        [
            pyarrow.field(column.name, _TYPES[column.kind], nullable=False, metadata={UNIT: column.unit})
            for column in table.columns
        ]
    )


def batches(table: ColumnTable, on_tick: OnTick) -> Iterator[Any]:
    """Yield the table as record batches."""
    made = schema(table)
    for values in table.blocks(on_tick):
        arrays = [pyarrow.array(part, field.type) for part, field in zip(values, made, strict=True)]
        yield pyarrow.record_batch(arrays, schema=made)
