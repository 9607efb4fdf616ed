import pytest

from simconsole.bridge.documents import LENIENT_BYTES, has_duplicate_keys, read
from simconsole.errors import RemoteProtocolError


def test_object_is_read() -> None:
    assert read(b' {"op": "x", "n": [1, null]} ') == ({"op": "x", "n": [1, None]}, False)


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
        read(text)


@pytest.mark.parametrize(
    ("text", "kind"), [(b"1", "a number"), (b"[]", "an array"), (b"null", "null"), (b"NaN", "null"), (b'"a"', "a s")]
)
def test_document_must_be_an_object(text: bytes, kind: str) -> None:
    with pytest.raises(RemoteProtocolError, match=f"message is {kind}"):
        read(text)


def test_literals_of_stock_clients_become_null_and_are_told() -> None:
    document = read(b'{"a": NaN, "b": [Infinity, -Infinity, 1], "c": "NaN \\" Infinity"}')
    assert document.fields == {"a": None, "b": [None, None, 1], "c": 'NaN " Infinity'}
    assert document.literals


def test_literals_in_strings_are_no_literals() -> None:
    assert read(b'{"a": "NaN"}') == ({"a": "NaN"}, False)


def test_long_text_is_not_searched_for_literals() -> None:
    with pytest.raises(RemoteProtocolError):
        read(b'{"a": NaN, "b": "' + b"x" * LENIENT_BYTES + b'"}')


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
    assert has_duplicate_keys(text, read(text).fields) is twice


def test_depth_beyond_any_message_is_refused() -> None:
    text = b'{"a":' + b"[" * 1000 + b"]" * 1000 + b"}"
    with pytest.raises(RemoteProtocolError, match="too deep"):
        has_duplicate_keys(text, read(text).fields)
