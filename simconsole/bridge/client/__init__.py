"""A rosbridge client."""

from simconsole.bridge.client.bridge_client import BridgeClient

__all__ = ["BridgeClient"]
