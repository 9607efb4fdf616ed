import logging
from collections.abc import Iterator
from pathlib import Path

import pytest

from simconsole.processes.notices import CAPACITY, Notice, NoticeReader, NoticeWriter, log_notices
from simconsole.values.errors import WorkerError


@pytest.fixture
def root() -> Iterator[logging.Logger]:
    logger = logging.getLogger()
    handlers = list(logger.handlers)
    yield logger
    logger.handlers[:] = handlers


def test_each_notice_of_each_process_is_taken_once_also_by_a_reader_started_again(tmp_path: Path) -> None:
    reader = NoticeReader(tmp_path)
    assert reader.take() == []
    NoticeWriter(tmp_path, "bridge").tell("WARN", "one")
    NoticeWriter(tmp_path, "canbus").tell("ERROR", "two")
    assert reader.take() == [Notice("WARN", "bridge: one"), Notice("ERROR", "canbus: two")]
    NoticeWriter(tmp_path, "bridge").tell("WARN", "of the process that was started again")
    assert NoticeReader(tmp_path).take() == [Notice("WARN", "bridge: of the process that was started again")]
    assert reader.take() == NoticeReader(tmp_path).take() == []


def test_too_long_a_text_is_cut_and_where_nobody_reads_memory_ends(tmp_path: Path) -> None:
    writer = NoticeWriter(tmp_path, "bridge")
    writer.tell("ERROR", "\U0001f697\u00e4\x01" * 300)
    for number in range(10 * CAPACITY):
        writer.tell("WARN", str(number))
    found = NoticeReader(tmp_path).take()
    assert len(found) == CAPACITY
    assert found[0].text.startswith("bridge: \U0001f697\u00e4\x01")
    assert found[0].text.endswith("...")
    assert found[1].text == "bridge: 0"


def test_what_a_process_warns_of_is_a_notice_and_stays_on_its_terminal(
    tmp_path: Path, root: logging.Logger, capsys: pytest.CaptureFixture[str]
) -> None:
    root.handlers.clear()
    log_notices(NoticeWriter(tmp_path, "bridge"))
    logger = logging.getLogger("simconsole.bridge.transport.server")
    logger.warning("%s took nothing for %g s and is cut", "127.0.0.1:5", 10.0)
    logger.error("worse")
    logger.info("127.0.0.1:6 connected")
    assert NoticeReader(tmp_path).take() == [
        Notice("WARN", "bridge: 127.0.0.1:5 took nothing for 10 s and is cut"),
        Notice("ERROR", "bridge: worse"),
    ]
    assert capsys.readouterr().err.splitlines() == ["127.0.0.1:5 took nothing for 10 s and is cut", "worse"]


def test_without_a_run_folder_nothing_can_be_told(tmp_path: Path) -> None:
    with pytest.raises(WorkerError):
        NoticeWriter(tmp_path / "gone", "bridge")
