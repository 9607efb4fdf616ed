"""Latency statistics as a table for people. Pure text."""

from collections.abc import Mapping
from typing import Any

HEAD = "| hop | p50, us | p99, us | max, us | count |\n| --- | ---: | ---: | ---: | ---: |"


def latency_table(hops: Mapping[str, Mapping[str, Any]]) -> str:
    """Return latency statistics (simconsole.values.latency) as a table in Markdown, a line for each hop."""
    lines = [
        f"| {hop} | {page['p50']:.0f} | {page['p99']:.0f} | {page['max']:.0f} | {page['count']:.0f} |"
        for hop, page in hops.items()
    ]
    return "\n".join((HEAD, *lines))
