from simconsole.hud.key_names import KEY_CODES, key_label
from simconsole.values.key_codes import Key


def test_every_key_has_a_label_that_stands_on_a_keyboard() -> None:
    assert set(KEY_CODES.values()) == set(Key)
    assert (key_label(Key.MANUAL), key_label(Key.RESET), key_label(Key.STEER_LEFT)) == ("Backspace", "R", "Left")
    assert all(key_label(key) for key in Key)
