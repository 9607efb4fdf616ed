"""WebSocket libraries by the name that a profile gives them; one is loaded when a listener is started."""

import importlib.util

from simconsole.bridge.transport.interface import StartListener
from simconsole.profiles.bridge import BridgeProfile
from simconsole.values.errors import ProfileError


def load_transport(profile: BridgeProfile) -> StartListener:
    """Return how to start a listener of the library that the profile names.

    Raises:
        ProfileError: that library is not installed.
    """
    if profile.transport == "websockets":
        from simconsole.bridge.transport import websockets_transport

        return websockets_transport.start_listener
    if importlib.util.find_spec("picows") is None:
        raise ProfileError("outputs.bridge.transport: picows is not installed: pip install 'simconsole[picows]'")
    from simconsole.bridge.transport import picows_transport

    return picows_transport.start_listener
