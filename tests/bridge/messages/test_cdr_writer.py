import struct

import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import deserialize, serialize

DEFINITION = "string text\nuint8 a\nfloat64 b\ndemo/Inner inner\nint64[2] ends\nuint16 last\n"
INNER = "bool yes\nfloat32 f\ndemo/Nothing nothing\nuint32 n\n"


@pytest.mark.parametrize("length", range(8))
def test_a_run_of_numbers_is_aligned_wherever_it_begins(length: int) -> None:
    registry = standard_registry()
    registry.add("demo/Nothing", "")
    registry.add("demo/Inner", INNER)
    registry.add("demo/Case", DEFINITION)
    plain = {
        "text": "x" * length,
        "a": 7,
        "b": -0.5,
        "inner": {"yes": True, "f": 0.25, "nothing": {}, "n": 9},
        "ends": [-1, 2**40],
        "last": 65535,
    }
    message = registry.from_plain("demo/Case", plain)
    data = serialize(registry, "demo/Case", message)
    assert registry.from_plain("demo/Case", deserialize(registry, "demo/Case", data)) == message
    # 4 bytes of count, the text, its end, one byte: the double begins at the next multiple of eight.
    (b,) = struct.unpack_from("<d", data, 4 + -(-(4 + length + 2) // 8) * 8)
    assert b == -0.5


def test_a_writer_is_made_once() -> None:
    registry = standard_registry()
    assert registry.cdr_writer("nav_msgs/Odometry") is registry.cdr_writer("nav_msgs/Odometry")
