"""Bench and conformance of any rosbridge server."""
