"""Compiled code of several processes in one: each kernel calls what it was compiled with."""

import os
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simconsole.values.host import jit
from simconsole.values.kernels import kernel
from tests.paths import ROOT

# Long enough that its callers call it, where a short one would be part of them.
LINES = "\n".join(
    f"""
        for at in range(len(row)):
            part = part * 0.9 + math.sin(row[at] * scale + {line}.0)
            for again in range(int(row[at]) % 3):
                part = part * 0.7 + math.cos(scale + again) * {line}.5
"""
    for line in range(8)
)
PROGRAM = f"""
import math
import sys

import numpy as np

from simconsole.values.host.jit import compiled
from simconsole.values.kernels import kernel, stage


def made(scale):
    @stage
    def scaled(row):
        part = 0.0
        {LINES}
        return part

    @kernel
    def twice(row):
        return scaled(row) + scaled(row[:3])

    return twice


ROW = np.linspace(0.0, 7.0, 20)
for scale in map(float, sys.argv[1:]):
    twice = made(scale)
    assert compiled(twice)(ROW) == twice(ROW), scale
"""


def test_what_two_processes_compiled_is_kept_apart_in_a_third(tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(PROGRAM)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "XDG_CACHE_HOME": str(tmp_path)}
    for scales in (["2"], ["3"], ["2", "3"], ["3", "2"]):
        command = [sys.executable, str(tmp_path / "program.py"), *scales]
        done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        assert done.returncode == 0, (scales, done.stderr)


@kernel
def halves(values: Any) -> float:
    return values[0] / 2.0 + values[1]  # type: ignore[no-any-return]


def test_two_processes_that_compile_at_once_write_each_its_own_code(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(jit, "held_alone", nullcontext)  # as on Windows, and on disks of other machines
    one, other, third = (jit._entry.__wrapped__(halves) for _ in range(3))  # as in three processes
    for dispatcher in (one, other):  # they look at the same time, before either has written
        monkeypatch.setattr(dispatcher._cache._cache_file, "_load_index", dict)
    row, every_second = np.array([2.0, 3.0]), np.array([2.0, np.nan, 3.0, np.nan])[::2]
    cache_file = other._cache._cache_file
    save = cache_file._save_data

    def late(*given: Any) -> None:
        """Write the code, after the one has written its index and code and the other its index."""
        one(every_second)
        save(*given)

    monkeypatch.setattr(cache_file, "_save_data", late)
    assert other(row) == 4.0
    assert third(row) == 4.0
    assert third(every_second) == 4.0
