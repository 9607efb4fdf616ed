"""Sockets, servers and files of the bridge."""
