"""What packages register: found as soon as they are there, loaded as what it must be, its parameters in bounds."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from simconsole.values.errors import ControllerError, ProfileError
from simconsole.values.registered import Bounded, bounded_values, found, identities, load, made
from tests.installed import installed

GROUP = "simconsole.tests"
KNOWN = {"mass_kg": Bounded(3.0, 1.0, 9.0), "drag": Bounded(0.5, 0.0, 1.0)}


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A package that registers a number, and a second thing that it does not have."""
    assert dict(found(GROUP)) == {}
    installed(tmp_path, GROUP, wrong="MISSING", right="VALUE")
    (tmp_path / "quick.py").write_text("VALUE = 7\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "quick", raising=False)
    yield
    sys.modules.pop("quick", None)


@pytest.mark.usefixtures("package")
def test_what_is_registered_is_found_by_name_and_loaded() -> None:
    assert list(found(GROUP)) == ["right", "wrong"]
    assert load(GROUP, "right", int, "key") == 7
    assert list(identities(GROUP)) == ["right = quick:VALUE quick 0.1.0", "wrong = quick:MISSING quick 0.1.0"]


@pytest.mark.usefixtures("package")
@pytest.mark.parametrize(
    ("name", "wanted", "told"),
    [
        ("other", int, "key: value other: one of right, wrong, as packages register them"),
        ("wrong", int, "key: value wrong: quick:MISSING: AttributeError: "),
        ("right", str, "key: value right: quick:VALUE: a str"),
        ("right", OSError, "key: value right: quick:VALUE: an OSError"),
    ],
)
def test_what_cannot_be_loaded_as_that_is_refused(name: str, wanted: type, told: str) -> None:
    with pytest.raises(ProfileError, match=f"^{told}"):
        load(GROUP, name, wanted, "key")


def test_a_parameter_is_in_its_bounds_which_it_may_reach_and_else_its_default() -> None:
    assert bounded_values(KNOWN, {"mass_kg": 9.0}, "key") == {"mass_kg": 9.0, "drag": 0.5}
    assert bounded_values(KNOWN, {"mass_kg": 1.0, "drag": 0.0}, "key") == {"mass_kg": 1.0, "drag": 0.0}
    for value in (0.99, 9.01, float("nan")):
        with pytest.raises(ProfileError, match=rf"^key: mass_kg: value {value:g}: 1 to 9$"):
            bounded_values(KNOWN, {"mass_kg": value}, "key")
    with pytest.raises(ProfileError, match=r"^key: wings: one of mass_kg, drag$"):
        bounded_values(KNOWN, {"wings": 2.0}, "key")


def test_what_is_made_has_no_flaw_and_an_error_of_ours_keeps_its_words() -> None:
    def no_flaws(thing: object) -> Iterator[str]:
        yield from ()

    def ours() -> int:
        raise ControllerError("worn out")

    def theirs() -> int:
        raise OSError("no\nlicence")

    assert made(lambda: 7, no_flaws, "key") == 7
    with pytest.raises(ProfileError, match=r"^key: first$"):
        made(lambda: 7, lambda thing: iter(("first", "second")), "key")
    with pytest.raises(ControllerError, match=r"^worn out$"):
        made(ours, no_flaws, "key")
    with pytest.raises(ProfileError, match=r"^key: OSError: no licence$"):
        made(theirs, no_flaws, "key")
