"""Every phrase that the driver's display can say, and whether a language file fits them."""

import difflib
import string
from functools import cache
from typing import Final

from simconsole.hud.advice import BAND, ONE_SPEED, PREPARE
from simconsole.hud.banner import ALERT_LABELS, DISTANCE, MODE_UNKNOWN, TIME
from simconsole.hud.captions import (
    ASK,
    AUTOPILOT,
    CONSOLE,
    MENDING,
    NOBODY,
    PRESS_TO_DRIVE,
    PRESS_TO_RESET,
    STEER_OR_BRAKE,
    WAIT,
    YOU,
)
from simconsole.hud.dial import AUTO, NO_DATA, THOUSAND_RPM, UP
from simconsole.hud.frame_times import DATA_AGE, DRAWING, FRAME, NO_DATA_YET, RATE
from simconsole.hud.key_names import BUTTON_WORDS, KEY_CODES, KEY_WORDS, WINDOW_WORDS, key_name
from simconsole.hud.panels import (
    AGE,
    BRAKE,
    CLIENTS,
    CLUTCH,
    DOWN,
    GAS,
    LAMPS,
    LEFT,
    LET_GO,
    LINK_ON,
    LINK_TITLE,
    LIVE,
    NO_COMMAND,
    NONE,
    OFF,
    ON,
    ONE_CLIENT,
    RIGHT,
    RUNNING,
    SILENT,
    STEERING,
    STRAIGHT,
    TOO_OLD,
)
from simconsole.hud.strip import RPM
from simconsole.hud.turn_sign import KILOMETRES, METRES, NOW
from simconsole.hud.view import FORCES, KMH, MPS, NOT_NOW, PAUSED, TWO_GEARS
from simconsole.profiles.view import LanguageProfile
from simconsole.values.errors import ProfileError
from simconsole.values.labels import (
    LINK_COMMANDER,
    LINK_CONNECTING,
    LINK_DOWN,
    LINK_LOST,
    LINK_NOBODY,
    LINK_RETRYING,
    mode_label,
    notice_label,
    reason_label,
    validity_label,
)
from simconsole.values.signals import Mode, Notice, Reason, Validity

_OF_PARTS: Final = (
    *(MODE_UNKNOWN, TIME, DISTANCE),
    *(AUTO, KMH, MPS, NO_DATA, THOUSAND_RPM, UP, RPM),
    *(RATE, FRAME, DRAWING, DATA_AGE, NO_DATA_YET),
    *(STEERING, CLUTCH, BRAKE, GAS, LEFT, RIGHT, STRAIGHT),
    *(LINK_TITLE, LINK_ON, LIVE, SILENT, NONE, NO_COMMAND, AGE, TOO_OLD, CLIENTS, ONE_CLIENT),
    *(RUNNING, OFF, ON, DOWN, LET_GO, TWO_GEARS, NOT_NOW, PAUSED),
    *(LINK_COMMANDER, LINK_CONNECTING, LINK_DOWN, LINK_LOST, LINK_NOBODY, LINK_RETRYING),
    *(NOW, METRES, KILOMETRES),
    *(BAND, ONE_SPEED, PREPARE),
    *(YOU, AUTOPILOT, CONSOLE, NOBODY),
    *(STEER_OR_BRAKE, WAIT, PRESS_TO_DRIVE, PRESS_TO_RESET, ASK),
)


@cache
def phrases() -> frozenset[str]:
    """Return every phrase, by its English."""
    labels = [
        *map(mode_label, Mode),
        *map(reason_label, Reason),
        *map(notice_label, Notice),
        *map(validity_label, Validity),
    ]
    alerts = [words for label in ALERT_LABELS.values() for words in label]
    keys = [key_name(code) for code in KEY_CODES]
    helped = [*KEY_WORDS.values(), *BUTTON_WORDS.values(), *WINDOW_WORDS.values()]
    named = [*_OF_PARTS, *LAMPS, *FORCES, *MENDING, *labels, *alerts, *helped]
    return frozenset((*named, *(name for name in keys if len(name) > 1))) - {""}


def check_language(language: LanguageProfile, origin: str) -> None:
    """Refuse a language that names phrases which the display never says, or fills in other things than they do.

    Args:
        language: What was read.
        origin: The file, which opens the message.

    Raises:
        ProfileError: names the phrase, and what is allowed.
    """
    known = phrases()
    for phrase, words in language.words.items():
        if phrase not in known:
            near = difflib.get_close_matches(phrase, known, 1)
            allowed = f'"{near[0]}"' if near else "a phrase of profiles/languages/german.yaml"
            raise ProfileError(f'{origin}: words: value "{phrase}": {allowed}')
        if _parts(words) != _parts(phrase):
            allowed = f"with {', '.join(sorted(_parts(phrase))) or 'no braces'}"
            raise ProfileError(f'{origin}: words."{phrase}": value "{words}": {allowed}')


def _parts(text: str) -> frozenset[str]:
    """Return what is to be filled in, in braces; text that cannot be filled in has its own."""
    try:
        found = list(string.Formatter().parse(text))
    except ValueError:
        return frozenset((text,))
    return frozenset(f"{{{name}{spec and ':'}{spec}}}" for _, name, spec, _ in found if name is not None)
