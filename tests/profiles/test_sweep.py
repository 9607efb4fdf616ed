"""The plan of a sweep: spans and seeds by their keys, and what is refused."""

import pytest

from simconsole.profiles.files.loader import parse
from simconsole.profiles.sweep import Span, SweepProfile
from tests.profiles.refused import refusal


def test_a_span_is_written_from_and_to_and_a_list_is_taken_as_it_stands() -> None:
    text = "schema: 1\nvalues:\n  body.mass_kg: {from: 1200, to: 1600, count: 3}\n  mode.tick_hz: [50, 100]\n"
    values = parse(text, SweepProfile, "f.yaml").values
    assert values == {"body.mass_kg": Span(first=1200.0, last=1600.0, count=3), "mode.tick_hz": (50, 100)}


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("values: {Body.mass_kg: [1]}", "Body.mass_kg"),
        ("values: {body.mass_kg: {from: 1, to: 2, count: 1}}", "count: value 1: "),
        ("values: {body.mass_kg: {first: 1, to: 2, count: 2}}", "first: value 1: unknown key"),
        ("seeds: {of: [], count: 2}", "seeds.of: "),
        ("seeds: {of: [devices.person.seed], count: 100001}", "seeds.count: value 100001: "),
        ("duration_s: 0", "duration_s: value 0: "),
        ("timeout: 5", "timeout: value 5: unknown key, did you mean timeout_s?"),
    ],
)
def test_what_cannot_be_meant_is_refused(text: str, told: str) -> None:
    assert told in refusal(f"schema: 1\n{text}\n", SweepProfile)
