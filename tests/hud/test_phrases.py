import re
from typing import Any

import msgspec
import pytest

from simconsole.hud.layout import layout, sample_views
from simconsole.hud.phrases import check_language, phrases
from simconsole.hud.view import HudSettings
from simconsole.profiles.files.loader import load
from simconsole.profiles.view import LanguageProfile
from simconsole.values.errors import ProfileError
from tests.hud.pictures import GERMAN, LARGE, SCREEN, texts


def a_language(**words: str) -> LanguageProfile:
    return LanguageProfile(schema=1, title="x", words=words)


class Heard(dict[str, str]):
    """Words that remember what was asked for."""

    def __init__(self) -> None:
        super().__init__()
        self.phrases: set[str] = set()

    def get(self, phrase: str, default: Any = None) -> Any:
        self.phrases.add(phrase)
        return default


def test_german_has_every_phrase_and_no_other() -> None:
    assert set(GERMAN.language.words) == phrases()


@pytest.mark.parametrize("name", ["english", "german"])
def test_shipped_languages_fit(name: str) -> None:
    check_language(load("languages", name, LanguageProfile), name)


def test_the_list_has_every_phrase_that_a_layout_says() -> None:
    heard = Heard()
    settings = HudSettings(language=msgspec.structs.replace(a_language(), words=heard))
    for screen in (SCREEN, LARGE["4:3"], SCREEN._replace(has_view=True)):
        for view in sample_views(settings):
            layout(view, screen)
    unknown = {phrase for phrase in heard.phrases - phrases() if not any(sign.isdigit() for sign in phrase)}
    assert unknown <= {"", "--"}


def test_no_word_of_the_layout_is_left_in_english() -> None:
    """Every letter that is drawn came through the language: with X for all phrases none is left."""
    crossed = {phrase: "X" + "".join(re.findall(r"\{.*?\}", phrase)) for phrase in phrases()}
    settings = HudSettings(language=a_language(**crossed))
    for screen in (SCREEN, LARGE["4:3"], SCREEN._replace(has_view=True)):
        for view in sample_views(settings):
            for item in texts(layout(view, screen)):
                left = {sign for sign in item.text if sign.isalpha()} - {"X"}
                allowed = set("ROS") | set("km") | set("paddle right, R3")
                assert left <= allowed, item.text


def test_all_that_an_alert_can_say_in_german_is_at_most_seven_words() -> None:
    for phrase, words in GERMAN.language.words.items():
        if phrase[0].islower() or phrase.startswith("refused"):
            assert len(words.split()) <= 7, words


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ({"PRAKED": "GEPARKT"}, 'x.yaml: words: value "PRAKED": "PARKED"'),
        ({"press {button} to drive": "drive"}, r'words\."press \{button\} to drive": value "drive": with \{button\}'),
        ({"{age} ms old": "{age.real} ms"}, r"with \{age\}"),
        ({"{age} ms old": "{age:9999} ms"}, r"with \{age\}"),
        ({"{age} ms old": "{age ms"}, r"with \{age\}"),
        ({"YOU": "{0}"}, "no braces"),
    ],
)
def test_a_language_that_does_not_fit_is_refused(words: dict[str, str], said: str) -> None:
    with pytest.raises(ProfileError, match=said):
        check_language(a_language(**words), "x.yaml")
