"""Ranges of numbers that several parts share, and how a part refuses what contradicts itself."""

from typing import Annotated, TypeAlias

from msgspec import Meta

Length: TypeAlias = Annotated[float, Meta(ge=0.01, le=10.0)]
Share: TypeAlias = Annotated[float, Meta(ge=0.0, le=1.0)]
Seconds: TypeAlias = Annotated[float, Meta(ge=0.001, le=5.0)]
Torque: TypeAlias = Annotated[float, Meta(ge=0.0, le=20000.0)]
Rpm: TypeAlias = Annotated[float, Meta(ge=0.0, le=20000.0)]
Ratio: TypeAlias = Annotated[float, Meta(ge=0.3, le=8.0)]
Title: TypeAlias = Annotated[str, Meta(max_length=200)]


def require(good: bool, what: str) -> None:
    """Refuse a profile whose values are each in bounds but contradict each other.

    Raises:
        ValueError: not `good`; `what` names the key, its value and what it must be. The reader adds file and path.
    """
    if not good:
        raise ValueError(what)
