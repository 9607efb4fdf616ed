"""The file of a running drive's scene: whole messages only, whatever happens to who writes it."""

import struct
from pathlib import Path

import pytest

from simconsole.scene.viewer.live_file import HEAD, HEAD_BYTES, LiveFile, messages_of
from simconsole.values.errors import WorkerError

TOP = HEAD + bytes(HEAD_BYTES - len(HEAD))


def message(kind: int, content: bytes) -> bytes:
    return struct.pack("<QQ", kind, len(content)) + content


FIRST, SECOND = message(1, b"map"), message(2, b"path") + message(2, b"")
INDEX = message(0, b"index") + b"offsets and RRF2FOOT"


def test_batches_become_one_stream_without_indices(tmp_path: Path) -> None:
    path = tmp_path / "scene.live.rrd"
    file = LiveFile(path)
    for messages in (FIRST, b"", SECOND):
        file.append(TOP + messages + INDEX)
    file.append(b"")
    assert path.read_bytes() == TOP + FIRST + SECOND
    assert file.length == path.stat().st_size
    file.close()


def test_who_comes_later_goes_on_in_the_file(tmp_path: Path) -> None:
    path = tmp_path / "scene.live.rrd"
    for messages in (FIRST, SECOND):
        file = LiveFile(path)
        file.append(TOP + messages + INDEX)
        file.close()
    assert path.read_bytes() == TOP + FIRST + SECOND


@pytest.mark.parametrize(
    "stream", [b"RRF3" + bytes(40), TOP, TOP + FIRST, TOP + FIRST[:5], TOP + message(2, b"x")[:-1]]
)
def test_what_is_no_whole_stream_is_refused_and_not_written(tmp_path: Path, stream: bytes) -> None:
    with pytest.raises(WorkerError, match="no stream of the kind"):
        messages_of(stream)
    file = LiveFile(tmp_path / "scene.live.rrd")
    with pytest.raises(WorkerError):
        file.append(stream)
    assert not (tmp_path / "scene.live.rrd").stat().st_size
    file.close()


def test_a_disk_that_is_full_leaves_whole_batches(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import os

    path = tmp_path / "scene.live.rrd"
    file = LiveFile(path)
    file.append(TOP + FIRST + INDEX)
    write = os.write
    monkeypatch.setattr(os, "write", lambda descriptor, content: write(descriptor, content[:7]))
    with pytest.raises(WorkerError, match=r"scene\.live\.rrd: .*full"):
        file.append(TOP + SECOND + INDEX)
    monkeypatch.undo()
    assert path.read_bytes() == TOP + FIRST
    file.append(TOP + SECOND + INDEX)
    assert path.read_bytes() == TOP + FIRST + SECOND
    file.close()


def test_a_folder_that_is_not_there_is_one_line(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match=r"nowhere/scene\.live\.rrd: the scene cannot be written"):
        LiveFile(tmp_path / "nowhere" / "scene.live.rrd")
