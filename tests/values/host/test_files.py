"""Files that are replaced at once: the old one or the new one, on disks that fill too, and never a draft beside it."""

import errno
import fcntl
import os
from pathlib import Path

import pytest

from simconsole.values.host.files import draft_of, give_back, held_alone, replaced, reserve, write_atomically


@pytest.mark.parametrize("durable", [True, False])
def test_a_file_is_replaced_whole(tmp_path: Path, durable: bool) -> None:
    path = tmp_path / "a.json"
    for content in ("first, and longer than the second ä", b"second"):
        write_atomically(path, content, durable)
        assert path.read_bytes() == (content.encode() if isinstance(content, str) else content)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("call", ["write", "ftruncate", "fsync"])
def test_what_was_there_stays_when_the_new_one_cannot_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str
) -> None:
    path = tmp_path / "a.json"
    write_atomically(path, "before")

    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, call, full)
    with pytest.raises(OSError, match="No space left"):
        write_atomically(path, "after")
    assert path.read_text() == "before"
    assert list(tmp_path.iterdir()) == [path]


def test_the_room_that_was_taken_is_used_and_what_is_left_of_it_given_back(tmp_path: Path) -> None:
    path = tmp_path / "a.json"
    reserve(path, 1 << 16)
    taken = draft_of(path).stat()
    assert (taken.st_size, taken.st_blocks * 512 >= 1 << 16) == (1 << 16, True)
    give_back(path, 1 << 14)
    assert draft_of(path).stat().st_size == 1 << 14
    give_back(path, 1 << 15)
    assert draft_of(path).stat().st_size == 1 << 14, "never more than it was"
    write_atomically(path, "content")
    assert path.stat().st_ino == taken.st_ino, "the same blocks"
    assert path.read_text() == "content"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("supported", [True, False])
def test_no_room_is_an_error_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, supported: bool
) -> None:
    def allocate(*_: object) -> None:
        raise OSError(errno.ENOSPC if supported else errno.EOPNOTSUPP, "no")

    monkeypatch.setattr(os, "posix_fallocate", allocate)
    if supported:
        with pytest.raises(OSError, match="no"):
            reserve(tmp_path / "a", 100)
        assert list(tmp_path.iterdir()) == []
    else:
        reserve(tmp_path / "a", 100)  # a file system that cannot: zeros are written
        assert draft_of(tmp_path / "a").read_bytes() == bytes(100)


def test_a_draft_that_fails_is_removed(tmp_path: Path) -> None:
    def fail() -> None:
        with replaced(tmp_path / "a") as draft:
            draft.write_text("half")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_is_held_is_nobody_elses_until_it_is_left(tmp_path: Path) -> None:
    lock = tmp_path / "lock"
    with held_alone(lock), lock.open("rb") as other, pytest.raises(BlockingIOError):
        fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
    with lock.open("rb") as other:
        fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)


def test_a_disk_without_locks_makes_nobody_wait(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(*_: object) -> None:
        raise OSError(errno.ENOSYS, "Function not implemented")

    monkeypatch.setattr(fcntl, "flock", none)
    with held_alone(tmp_path / "lock"), held_alone(tmp_path / "lock"):
        assert (tmp_path / "lock").exists()
