"""Keys stay held for the moment in which a pop-up takes the keyboard, and not for good."""

from collections import defaultdict

import pygame
import pytest

from simconsole.hud.key_names import KEY_CODES
from simconsole.hud.window.held_keys import KEPT_S, HeldKeys, pressed_keys
from simconsole.values.key_codes import Key

GAS = int(Key.THROTTLE | Key.STEER_LEFT)


def test_keys_become_one_mask(monkeypatch: pytest.MonkeyPatch) -> None:
    held = defaultdict(bool, {pygame.K_LEFT: True, pygame.K_w: True, pygame.K_ESCAPE: True, pygame.K_z: True})
    monkeypatch.setattr(pygame.key, "get_pressed", lambda: held)
    assert pressed_keys() == Key.STEER_LEFT | Key.THROTTLE | Key.EMERGENCY_STOP


def test_every_meaning_has_a_key_and_fits_a_float() -> None:
    assert set(KEY_CODES.values()) == set(Key)
    assert int(float(sum(Key))) == sum(Key)


def test_keys_held_when_the_window_loses_the_keyboard_stay_held_for_a_while() -> None:
    keys = HeldKeys()
    assert keys.mask(GAS, focused=True, now_s=10.0) == GAS
    for late_s in (0.02, 1.0, KEPT_S):
        assert keys.mask(0, focused=False, now_s=10.0 + late_s) == GAS
    assert keys.mask(0, focused=False, now_s=10.1 + KEPT_S) == 0


def test_what_is_let_go_of_before_or_after_is_not_held() -> None:
    keys = HeldKeys()
    keys.mask(GAS, focused=True, now_s=10.0)
    keys.mask(int(Key.BRAKE), focused=True, now_s=10.1)
    assert keys.mask(0, focused=False, now_s=10.2) == Key.BRAKE
    assert keys.mask(0, focused=True, now_s=10.3) == 0
    assert keys.mask(0, focused=False, now_s=10.4) == 0


def test_a_window_system_without_focus_tells_its_keys_all_the_same() -> None:
    assert HeldKeys().mask(GAS, focused=False, now_s=0.0) == GAS
