"""Numbers that a row stores: masks that a float carries exactly, and no two meanings of one number."""

from enum import EnumType, IntEnum, IntFlag

import pytest

from simconsole.values.signals import codes

KINDS = [kind for kind in vars(codes).values() if isinstance(kind, EnumType) and kind not in (IntEnum, IntFlag)]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_number_has_one_meaning_and_is_a_float_exactly(kind: type[IntEnum] | type[IntFlag]) -> None:
    assert len(kind.__members__) == len(set(kind)), "no number has two names"
    for member in kind:
        assert int(float(member)) == member
        if issubclass(kind, IntFlag):
            assert member.bit_count() == 1
    assert float(sum(kind)) == sum(kind), "all of a mask at once"


def test_only_refusals_are_numbered_from_twenty_on() -> None:
    for reason in codes.Reason:
        assert reason.name.startswith("REFUSED_") == (reason >= 20)
