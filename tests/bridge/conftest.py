from tests.bridge.fixtures import bridge, control, join, peer, serving, snapshot, transport

__all__ = ["bridge", "control", "join", "peer", "serving", "snapshot", "transport"]
