"""Strict YAML: what is read, as which value, and what is refused where."""

import json
import math

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from simconsole.profiles.strict_yaml import MAX_DEPTH, Plain, parse, to_text
from simconsole.values.errors import ProfileError

scalars = st.none() | st.booleans() | st.integers(-(2**63) + 1, 2**63 - 1) | st.text(st.characters(codec="utf-8"))
finite = st.floats(allow_nan=False, allow_infinity=False)
documents = st.recursive(
    scalars | finite,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text("abc_d", min_size=1), inner, max_size=4),
    max_leaves=20,
)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1", 1),
        ("-7", -7),
        ("0x1F", 31),
        ("1e-3", 0.001),
        (".5", 0.5),
        ("+2.50", 2.5),
        ("true", True),
        ("null", None),
        ("~", None),
        ("no", "no"),
        ("on", "on"),
        ("1:30", "1:30"),
        ("2026-11-20", "2026-11-20"),
        ("'1'", "1"),
        ('"true"', "true"),
        ("nano", "nano"),
        ("left turn", "left turn"),
    ],
)
def test_scalar_has_the_value_a_reader_expects(text: str, value: Plain) -> None:
    document = parse(f"key: {text}\n", "f.yaml")
    assert document == {"key": value}
    assert isinstance(document, dict)
    assert type(document["key"]) is type(value)


def test_nested_document_keeps_order_and_shape() -> None:
    text = "wheel:\n  axis: 0\n  range_deg: 900.0\nbuttons:\n- {role: autonomous, index: 3}\n- []\n"
    assert json.dumps(parse(text, "f.yaml")) == (
        '{"wheel": {"axis": 0, "range_deg": 900.0}, "buttons": [{"role": "autonomous", "index": 3}, []]}'
    )


def test_deepest_allowed_nesting_is_read() -> None:
    assert parse("[" * MAX_DEPTH + "1" + "]" * MAX_DEPTH, "f.yaml") is not None
    with pytest.raises(ProfileError, match=r"^f\.yaml: line 1: nesting deeper than 32 is not allowed"):
        parse("[" * (MAX_DEPTH + 1) + "1" + "]" * (MAX_DEPTH + 1), "f.yaml")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "f.yaml: file: empty: a mapping of keys and values"),
        ("# only a remark\n", "f.yaml: file: empty: a mapping of keys and values"),
        ("a: 1\nb: 2\na: 3\n", "f.yaml: line 3: key 'a' a second time is not allowed: each key once"),
        ("a: 1\n---\nb: 1\n", "f.yaml: line 2: a second document is not allowed: one document per file"),
        ("a:\n  <<: {b: 1}\n", "f.yaml: line 2: merge key << is not allowed: write the values out"),
        ("[1]: 2\n", "f.yaml: line 1: a key that is not plain text is not allowed: text as key"),
        ("a: {b: [1, .nan]}\n", "f.yaml: a.b[1]: value .nan: a finite number"),
        ("a: -.inf\n", "f.yaml: a: value -.inf: a finite number"),
        ("a: Infinity\n", "f.yaml: a: value Infinity: a finite number"),
        ("a: 1e999\n", "f.yaml: a: value 1e999: a finite number"),
        ("a: 99999999999999999999\n", "f.yaml: a: value 99999999999999999999: a whole number within 64 bits"),
    ],
)
def test_refused_text_names_its_place(text: str, message: str) -> None:
    with pytest.raises(ProfileError) as caught:
        parse(text, "f.yaml")
    assert str(caught.value) == message


@pytest.mark.parametrize("text", ["a: [1,", "a: 'x", "a: b: c", "\ta: 1", "a: \x00", "a: \ud800", "%YAML 9", "{,}"])
def test_text_that_is_not_yaml_is_one_line(text: str) -> None:
    with pytest.raises(ProfileError, match=r"^f\.yaml: (line \d+|text): [^\n]*$"):
        parse(text, "f.yaml")


@given(st.text())
def test_any_text_gives_values_or_one_line(text: str) -> None:
    message = ""
    try:
        parse(text, "f.yaml")
    except ProfileError as error:
        message = str(error)
    assert "\n" not in message


@given(documents)
def test_what_is_written_reads_back_equal(document: Plain) -> None:
    again = parse(to_text(document), "f.yaml")
    assert json.dumps(again, sort_keys=True) == json.dumps(document, sort_keys=True)


def test_text_of_equal_profiles_is_equal_bytes() -> None:
    class Profile(msgspec.Struct, frozen=True, kw_only=True):
        gains: dict[str, float]
        ratio: float = 1 / 3

    first, second = Profile(gains={"b": 1e-7, "a": math.pi}), Profile(gains={"a": math.pi, "b": 1e-7})
    assert to_text(first) == to_text(second)
    assert parse(to_text(first), "f.yaml") == {"gains": {"a": math.pi, "b": 1e-7}, "ratio": 1 / 3}
