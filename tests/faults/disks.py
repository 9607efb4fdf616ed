"""Disks that fail for real: small file systems that fill, turn read-only or lose a folder while a drive is recorded."""

import os
import resource
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import NamedTuple

import pytest

SIZE_BYTES = 16 << 20


class Disk(NamedTuple):
    """A way in which a disk fails: on `mounted` it fails at once when `fail` is called with the bundle's folder."""

    name: str
    mounted: Callable[[Path], AbstractContextManager[None]]
    fail: Callable[[Path], None]


@contextmanager
def memory(folder: Path) -> Iterator[None]:
    """Mount a file system in memory."""
    with _mounted(folder, "-t", "tmpfs", "-o", f"size={SIZE_BYTES}", "tmpfs"):
        yield


@contextmanager
def ext4(folder: Path) -> Iterator[None]:
    """Mount a real one, in a file beside the folder."""
    image = folder.with_name(f"{folder.name}.ext4")
    with image.open("wb") as file:
        file.truncate(SIZE_BYTES)
    subprocess.run(["mkfs.ext4", "-q", image], check=True)
    with _mounted(folder, "-o", "loop", image):
        yield


@contextmanager
def limited(folder: Path) -> Iterator[None]:
    """Give the limit on the size of a file back."""
    folder.mkdir()
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@contextmanager
def _mounted(folder: Path, *words: object) -> Iterator[None]:
    if os.geteuid() != 0:
        pytest.skip("only root may mount a file system")
    folder.mkdir()
    subprocess.run(["mount", *map(str, words), folder], check=True)
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", folder], check=True)


def fill(folder: Path) -> None:
    """Take the last byte of the disk that a bundle lies on."""
    filler = os.open(folder.parent / "filler", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    try:
        for size in (1 << 20, 1 << 12, 1):
            while True:
                try:
                    os.write(filler, bytes(size))
                except OSError:
                    break
    finally:
        os.close(filler)


def limit(folder: Path) -> None:
    """Let no file grow beyond what the log has, as a quota does."""
    size = (folder / "drive.log").stat().st_size
    resource.setrlimit(resource.RLIMIT_FSIZE, (size + 1000, resource.getrlimit(resource.RLIMIT_FSIZE)[1]))


def make_read_only(folder: Path) -> None:
    """Do what a file system does to itself after an error."""
    subprocess.run(["mount", "-o", "remount,abort", folder.parent], check=True)


DISKS = (
    Disk("full", memory, fill),
    Disk("quota", limited, limit),
    Disk("read-only", ext4, make_read_only),
    Disk("removed", memory, shutil.rmtree),
)
