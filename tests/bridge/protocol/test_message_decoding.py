import itertools
import struct

import cbor2
import msgspec
import pytest

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.protocol.message_decoding import (
    LENIENT_BYTES,
    TYPED_ARRAYS,
    Binary,
    all_finite,
    decode,
    has_duplicate_keys,
    read_complete,
)
from simconsole.values.errors import RemoteProtocolError


def test_object_is_read() -> None:
    assert decode(b' {"op": "x", "n": [1, null]} ') == ({"op": "x", "n": [1, None]}, False)


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"{",
        b'{"a":1}x',
        b'{"a":1}{"b":2}',
        b"{'a':1}",
        b'{"a":01}',
        b'{"a":1,}',
        b'\xef\xbb\xbf{"a":1}',
        b'{"a":"\x00"}',
        b'{"a":"\xff"}',
        b'{"a":"\\ud800"}',
        b'{"a":1e999}',
        b"[" * 100_000,
        b'{"a":' * 100_000,
        b'{"a":NaN',
        b'{"a":-NaN}',
        b'{"a":Infinityx}',
        b'{"a":"' + b'\\"' * 30_000 + b"NaN",
    ],
)
def test_what_is_no_json_document(text: bytes) -> None:
    with pytest.raises(RemoteProtocolError, match="not one JSON document"):
        decode(text)


@pytest.mark.parametrize(
    ("text", "kind"), [(b"1", "a number"), (b"[]", "an array"), (b"null", "null"), (b"NaN", "null"), (b'"a"', "a s")]
)
def test_document_must_be_an_object(text: bytes, kind: str) -> None:
    with pytest.raises(RemoteProtocolError, match=f"message is {kind}"):
        decode(text)


def test_literals_of_stock_clients_become_null_and_are_told() -> None:
    document = decode(b'{"a": NaN, "b": [Infinity, -Infinity, 1], "c": "NaN \\" Infinity"}')
    assert document.fields == {"a": None, "b": [None, None, 1], "c": 'NaN " Infinity'}
    assert document.literals


def test_literals_in_strings_are_no_literals() -> None:
    assert decode(b'{"a": "NaN"}') == ({"a": "NaN"}, False)


def test_long_text_is_not_searched_for_literals() -> None:
    with pytest.raises(RemoteProtocolError):
        decode(b'{"a": NaN, "b": "' + b"x" * LENIENT_BYTES + b'"}')


@pytest.mark.parametrize(
    ("text", "twice"),
    [
        (b'{"a":1,"b":{"a":2}}', False),
        (b'{"a":1,"a":1}', True),
        (b'{"a":{"x":1,"x":2}}', True),
        (b'{"a":[{"x":1},{"x":2}]}', False),
        (b'{"a":[{"x":1,"x":2}]}', True),
        (b'{"a":"\\"","b":1}', False),
        (b'{"a":"\\"","a":1}', True),
        (b'{"a":1,"\\u0061":2}', True),
        (b'{"\xc3\xa4":"\xe2\x82\xac","":""}', False),
        (b'{"a":12345678901234567890123,"b":1e5}', False),
    ],
)
def test_keys_given_twice(text: bytes, twice: bool) -> None:
    assert has_duplicate_keys(text, decode(text).fields) is twice


def test_depth_beyond_any_message_is_refused() -> None:
    for depth, escape in itertools.product((31, 32, 1000), (b"", b"\\u0062")):
        text = b'{"a":' + b"[" * depth + b"]" * depth + b',"' + escape + b'":[{},[],[]]}'
        if depth == 31:
            assert not has_duplicate_keys(text, decode(text).fields)
        else:
            with pytest.raises(RemoteProtocolError, match="nested deeper than 32"):
                decode(text)
    assert decode(b'{"a":[' + b"[]," * 100 + b"1]}").fields["a"][100] == 1


def test_cbor_is_read() -> None:
    message = {"op": "x", "n": [1, None, 1.5, "t", b"o", True, 2**64 - 1], "d": {"ä": -1}}
    assert decode(Binary(cbor2.dumps(message))) == (message, False)
    assert not has_duplicate_keys(Binary(cbor2.dumps(message)), message)


@pytest.mark.parametrize(
    ("tag", "letter"),
    [(64, "B"), (69, "H"), (70, "I"), (71, "Q"), (72, "b"), (77, "h"), (78, "i"), (79, "q"), (85, "f"), (86, "d")],
)
def test_typed_arrays_are_lists_and_octets_stay(tag: int, letter: str) -> None:
    octets = struct.pack(f"<3{letter}", 1, 2, 3)
    value = decode(Binary(cbor2.dumps({"a": cbor2.CBORTag(tag, octets)}))).fields["a"]
    assert value == (octets if letter == "B" else [1, 2, 3])
    if letter != "B":
        for wrong in (
            cbor2.CBORTag(tag, octets[1:]) if letter != "b" else cbor2.CBORTag(tag, 1),
            cbor2.CBORTag(tag, "x"),
        ):
            with pytest.raises(RemoteProtocolError, match="a tag other than"):
                decode(Binary(cbor2.dumps({"a": wrong})))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff",
        b"\xa1\x61a\x01\x01",
        b"\xa1\x01\x01",
        b"\xa1\x41a\x01",
        b"\xa1\x61a\xf7",
        b"\xa1\x61a\xf8\x20",
        b"\xa1\x61a\x62\xff\xff",
        b"\xa1\x61a\x3b" + b"\xff" * 8,
        b"\xa2\x61a\x01\x61a\x02",
        b"\xbf\x61a\x01\xff",
        b"\x9b\x7f" + b"\xff" * 7,
        b"\x5b\x7f" + b"\xff" * 7,
        b"\xbb\x7f" + b"\xff" * 7,
        b"\x81" * 100_000,
        b"\xa1\x61a\xc2\x5a\x00\x03\xff\x00" + b"\xff" * 0x3FF00,
    ],
    ids=range(16),
)
def test_what_is_no_cbor_document(data: bytes) -> None:
    with pytest.raises(RemoteProtocolError, match="not one CBOR document"):
        decode(Binary(data))


def test_no_other_tag_is_read_whatever_the_library_makes_of_it() -> None:
    allowed = set()
    for number in range(70_000):
        head = bytes([0xC0 | number]) if number < 24 else b"\xda" + number.to_bytes(4, "big")
        try:
            decode(Binary(b"\xa1\x61a" + head + b"\x48" + bytes(8)))
        except RemoteProtocolError:
            continue
        allowed.add(number)
    assert allowed == set(TYPED_ARRAYS)


def test_only_what_a_message_encodes_to_is_complete() -> None:
    point = standard_registry().struct("geometry_msgs/Point")
    reader = msgspec.json.Decoder(point)
    assert read_complete(b'{"x":1.0,"y":-2.5,"z":0.0}', reader) == point(1.0, -2.5, 0.0)
    for text in (
        b'{"x":1.0,"y":-2.5}',
        b'{"y":-2.5,"x":1.0,"z":0.0}',
        b'{"x":1.0,"y":-2.5,"z":0.0,"z":0.0}',
        b'{"x":1.0,"x":1.0,"y":-2.5}',
        b'{"x":1,"y":-2.5,"z":0.0}',
        b'{"x":1.0, "y":-2.5,"z":0.0}',
        b'{"x":NaN,"y":-2.5,"z":0.0}',
        b'{"x":null,"y":-2.5,"z":0.0}',
        b'{"x":1.0,"y":-2.5,"z":0.0,"w":0.0}',
        b'{"x":1.0,"y":-2.5,"z":0.0}}',
        b"",
    ):
        assert read_complete(text, reader) is None, text


def test_numbers_that_json_has_no_word_for_are_found_wherever_they_are() -> None:
    assert all_finite({"a": [1, 2.0, {"b": "nan"}], "c": None})
    assert not all_finite({"a": [1, {"b": [float("nan")]}]})
    assert not all_finite(float("-inf"))
