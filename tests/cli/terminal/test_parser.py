"""Words that no command knows get a guess; every page of help has examples that can be typed."""

import shlex
from collections.abc import Callable

import pytest

from simconsole.cli.main import parser
from simconsole.cli.terminal.parser import Parser

PAGES = list(parser().pages())


@pytest.fixture
def refusal(capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    def said(*words: str) -> str:
        with pytest.raises(SystemExit) as refused:
            parser().options_of(words)
        assert refused.value.code == 2
        return capsys.readouterr().err.rstrip()

    return said


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (("dirve",), "did you mean drive?"),
        (("drive", "--headles"), "did you mean --headless?"),
        (("drive", "--partcipant=7"), "did you mean --participant?"),
        (("world", "lsit"), "did you mean list?"),
        (("operate", "takover"), "did you mean takeover?"),
        (("export", "b", "--to", "parket"), "did you mean parquet?"),
        (("drive", "demo", "--xyzzy"), "see simconsole drive --help"),
        (("devices", "list", "--virtaul"), "did you mean --virtual?"),
        (("devices", "list", "--weight=1"), "see simconsole devices list --help"),
        (("--json", "devices", "list"), "--json belongs behind simconsole devices list"),
    ],
)
def test_an_unknown_word_gets_a_guess(refusal: Callable[..., str], words: tuple[str, ...], meant: str) -> None:
    assert refusal(*words).endswith(meant)


def test_where_no_guess_is_near_all_are_named(refusal: Callable[..., str]) -> None:
    assert refusal("world", "xyzzy").endswith("value xyzzy: one of list, show, import, export")


def words_of_the_examples(page: Parser) -> list[list[str]]:
    """The words of each line at the end of a page."""
    head, *lines = str(page.epilog).splitlines()
    assert head == "for example:"
    assert all(line.startswith(f"  {page.prog}") for line in lines)
    return [shlex.split(line)[1:] for line in lines]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.prog)
def test_every_page_is_of_all_that_is_below_it_or_has_an_example_that_can_be_typed(page: Parser) -> None:
    assert page.format_help().startswith(f"usage: {page.prog} ")
    if page.commands:
        assert f"{page.prog} " in str(page.epilog)
        return
    shown = [parser().options_of(words) for words in words_of_the_examples(page)]
    assert shown
    commands = page.prog.split()[1:]
    assert all({*commands} <= {word for word in vars(options).values() if isinstance(word, str)} for options in shown)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.prog)
def test_every_argument_is_explained(page: Parser) -> None:
    assert [one.dest for one in page._actions if not one.help and not one.choices] == []
    assert page.description


def test_each_action_has_a_page_of_its_own() -> None:
    pages = {page.prog for page in PAGES}
    assert {"simconsole devices calibrate", "simconsole bridge cert", "simconsole operate mark"} <= pages
    assert "--weight" not in next(page for page in PAGES if page.prog == "simconsole devices list").options
