"""Phrases in the driver's language. The English of a phrase is its name; `simconsole.hud.phrases` has them all."""

from simconsole.profiles.view import LanguageProfile


def say(language: LanguageProfile, phrase: str, **parts: str) -> str:
    """Return a phrase in the driver's language, its braces filled in; one that the language lacks stays English."""
    text = language.words.get(phrase, phrase)
    return text.format(**parts) if parts else text


def number(language: LanguageProfile, value: float, digits: int) -> str:
    """Return a number with `digits` decimals, as the language writes it."""
    return f"{value:.{digits}f}".replace(".", language.decimal_mark)
