from tests.bridge.fixtures import bridge, control, join, peer, serving, snapshot

__all__ = ["bridge", "control", "join", "peer", "serving", "snapshot"]
