"""How tests of profiles look at what is refused."""

import pytest

from simconsole.profiles.files.loader import parse
from simconsole.values.errors import ProfileError


def refusal(text: str, kind: type) -> str:
    """Return the message with which a profile of this kind is refused; fail where it is read."""
    with pytest.raises(ProfileError) as refused:
        parse(text, kind, "f.yaml")
    told = str(refused.value)
    assert told.startswith("f.yaml: ")
    assert "\n" not in told
    return told
