from simconsole.hud.language import number, say
from simconsole.profiles.view import ENGLISH, LanguageProfile

FRENCH = LanguageProfile(
    schema=1, title="Français", decimal_mark=",", words={"YOU": "VOUS", "press {button} to drive": "{button} : partir"}
)


def test_what_a_language_lacks_stays_english() -> None:
    assert [say(FRENCH, phrase) for phrase in ("YOU", "NOBODY")] == ["VOUS", "NOBODY"]
    assert say(ENGLISH, "YOU") == "YOU"


def test_braces_are_filled_in_and_what_fills_them_is_no_phrase() -> None:
    assert say(FRENCH, "press {button} to drive", button="{R3}") == "{R3} : partir"
    assert say(ENGLISH, "press {button} to drive", button="R3") == "press R3 to drive"


def test_numbers_have_the_languages_mark() -> None:
    assert number(FRENCH, 1.25, 2) == "1,25"
    assert number(ENGLISH, 1.25, 2) == "1.25"
