import numpy as np
import pytest

from simconsole.world.traffic.road_users import (
    CAPACITY,
    FIELDS,
    NOBODY,
    RECORD_WIDTH,
    RoadUser,
    RoadUserKind,
    from_bytes,
    from_record,
    table,
    to_bytes,
    to_record,
    users,
)
from tests.bits import difference


def some(count: int) -> list[RoadUser]:
    values = np.random.default_rng(1).uniform(-1e5, 1e5, (count, FIELDS))
    return [RoadUser(*row) for row in values.tolist()]


@pytest.mark.parametrize("count", [0, 1, CAPACITY])
def test_messages_and_records_bring_back_every_bit(count: int) -> None:
    rows = table(some(count))
    assert users(rows) == tuple(some(count))
    assert not difference(from_bytes(to_bytes(rows)), rows)
    assert not difference(from_record(to_record(rows)), rows)
    assert len(to_record(rows)) == RECORD_WIDTH
    assert to_record(rows)[0] == count


def test_tables_of_before_heights_and_indicators_are_read() -> None:
    rows = table(some(3))[:, :9]
    read = from_bytes(to_bytes(rows), "float64[9]")
    assert (read[:, :9] == rows).all()
    assert not read[:, 9:].any()
    with pytest.raises(ValueError, match=r"encoding 'float64\[7\]'"):
        from_bytes(b"", "float64[7]")


def test_message_is_little_endian_rows_of_fields() -> None:
    user = RoadUser(
        id=7.0,
        kind=float(RoadUserKind.VAN),
        x_m=1.0,
        y_m=2.0,
        yaw_rad=0.5,
        speed_mps=3.0,
        length_m=5.5,
        width_m=2.0,
        height_m=2.3,
    )
    assert np.frombuffer(to_bytes(table([user])), "<f8").tolist() == list(user)
    assert NOBODY.shape == (0, FIELDS)


@pytest.mark.parametrize("size", [1, 8, 8 * FIELDS + 8, 8 * FIELDS * (CAPACITY + 1)])
def test_what_is_no_table_is_refused(size: int) -> None:
    with pytest.raises(ValueError, match="road users"):
        from_bytes(bytes(size))
