"""Types and bounds in words."""

from typing import Annotated, Literal

import msgspec
import pytest
from msgspec import Meta

from simconsole.profiles.keys.key_types import bounds_text, type_text
from simconsole.profiles.validation import worded


@pytest.mark.parametrize(
    ("kind", "said", "bounds"),
    [
        (Annotated[float, Meta(ge=0.5, le=2.0)], "number", "0.5 to 2"),
        (Annotated[float, Meta(gt=0.0, le=2.0)] | None, "number or null", "above 0 and 2 or less"),
        (Annotated[int, Meta(ge=0, le=2**53)], "whole number", "0 to 9007199254740992"),
        (Annotated[float, Meta(ge=0.0)], "number", "0 or more"),
        (Literal["front", "rear"], "text", "one of front, rear"),
        (Literal[1], "whole number", "1"),
        (tuple[str, ...], "list of texts", ""),
        (Annotated[tuple[Annotated[int, Meta(ge=1, le=3)], ...], Meta(max_length=4)], "list of whole numbers",
         "4 or less entries; each 1 to 3"),
        (tuple[float, float], "list of 2 numbers", ""),
        (dict[str, float], "mapping of numbers", ""),
        (bool, "true or false", ""),
        (Annotated[str, Meta(max_length=3)], "text", "3 or less characters"),
        (Annotated[str, worded("^a+$", "some a, up to 3", max_length=3)], "text", "some a, up to 3"),
    ],
)  # fmt: skip
def test_a_type_in_words(kind: object, said: str, bounds: str) -> None:
    info = msgspec.inspect.type_info(kind)
    assert (type_text(info), bounds_text(info)) == (said, bounds)
