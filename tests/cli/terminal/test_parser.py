"""Words that no command knows get a guess."""

from collections.abc import Callable

import pytest

from simconsole.cli.main import parser


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
    ],
)
def test_an_unknown_word_gets_a_guess(refusal: Callable[..., str], words: tuple[str, ...], meant: str) -> None:
    assert refusal(*words).endswith(meant)


def test_where_no_guess_is_near_all_are_named(refusal: Callable[..., str]) -> None:
    assert refusal("world", "xyzzy").endswith("value xyzzy: one of list, show, import, export")
