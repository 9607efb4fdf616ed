from simconsole.values.labels import (
    EASED_BELOW,
    arbitration_label,
    eased_label,
    gear_label,
    indicator_label,
    is_eased,
    mode_label,
    notice_label,
    reason_label,
    validity_label,
)
from simconsole.values.signals import Mode, Notice, Reason, Validity


def test_every_mode_reason_and_validity_has_words_of_its_own() -> None:
    for words, members in (
        (mode_label, Mode),
        (reason_label, Reason),
        (validity_label, Validity),
        (notice_label, Notice),
    ):
        texts = [words(float(member)) for member in members]
        assert len(set(texts)) == len(members), texts
        # An unknown number names itself; a known one must not.
        assert not any(character.isdigit() for text in texts for character in text), texts


def test_no_mode_is_named_in_words_that_only_a_standard_knows() -> None:
    assert mode_label(Mode.MINIMAL_RISK) == "SAFE STOP"
    assert not [mode for mode in Mode if "RISK" in mode_label(mode) or "_" in mode_label(mode)]


def test_words_are_short_and_printable() -> None:
    for text in (*map(reason_label, Reason), *map(notice_label, Notice)):
        assert len(text.split()) <= 7
        assert text.isascii()
        assert text.isprintable()


def test_a_refusal_says_so_and_nothing_else_does() -> None:
    for reason in Reason:
        assert reason_label(reason).startswith("refused: ") == reason.name.startswith("REFUSED_")


def test_an_unknown_number_names_itself() -> None:
    assert mode_label(99.0) == "MODE 99"
    assert reason_label(2.5) == "reason 2.5"
    assert validity_label(-1.0) == "validity -1"
    assert notice_label(99.0) == "notice 99"


def test_the_lever_reads_as_its_knob() -> None:
    assert [gear_label(gear) for gear in (-1.0, 0.0, 1.0, 6.0)] == ["R", "N", "1", "6"]


def test_indicators_are_named_by_their_side() -> None:
    assert [indicator_label(side) for side in (-1.0, 0.0, 1.0)] == ["right", "off", "left"]


def test_one_line_tells_what_was_decided_refused_and_noticed() -> None:
    plain = arbitration_label(Mode.MANUAL, Reason.ARMED, 0.0, Notice.NONE)
    assert plain == "MANUAL: controls ready"
    refused = arbitration_label(Mode.AUTONOMOUS, Reason.PERSON_ASKED, Reason.REFUSED_IMPLAUSIBLE, 1.0, "12 m/s2")
    assert refused == (
        "AUTONOMOUS: driver asked; refused: too much lateral acceleration (12 m/s2); "
        "throttle is held: autopilot only steers"
    )


def test_wheel_is_eased_only_while_it_gives_some_and_less_than_all() -> None:
    assert [is_eased(1.0, share) for share in (0.0, 0.5, EASED_BELOW, 1.0)] == [False, True, False, False]
    assert not is_eased(0.0, 0.5)
    assert eased_label(0.994) == "force feedback eased to 99 %", "never 100"
