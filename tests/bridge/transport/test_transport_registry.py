import importlib.util

import pytest

from simconsole.bridge.transport.transport_registry import load_transport
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError


def test_library_that_is_not_there_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    assert load_transport(BridgeProfile()) is not None
    with pytest.raises(ProfileError, match=r"outputs\.bridge\.transport: picows is not installed"):
        load_transport(BridgeProfile(transport="picows"))
