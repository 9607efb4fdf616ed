"""Buses, and the worker that speaks on one."""
