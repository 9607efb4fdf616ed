"""F01 to F04 of the fault catalogue: names and contents of profiles that must be refused, whole and with one line."""

import builtins
import io
import os
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Annotated, Any

import msgspec
import pytest

from simconsole.profiles.files import loader as profile_files
from simconsole.values.errors import ProfileError

OUTSIDE = "friction: 0.7\n"


class Tyre(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    friction: Annotated[float, msgspec.Meta(ge=0.05, le=1.5)] = 0.9
    mass_kg: Annotated[float, msgspec.Meta(gt=0, le=100)] = 20.0


class Car(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    front: Tyre = Tyre()
    track_m: Annotated[float, msgspec.Meta(ge=0.5, le=3)] = 1.5


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The name of every file opened while the test runs, by whatever way."""
    names: list[str] = []

    def watched(function: Callable[..., Any]) -> Callable[..., Any]:
        def call(file: Any, *args: Any, **kwargs: Any) -> Any:
            names.append(os.fspath(file) if not isinstance(file, int) else str(file))
            return function(file, *args, **kwargs)

        return call

    monkeypatch.setattr(io, "open", watched(io.open))
    monkeypatch.setattr(builtins, "open", watched(builtins.open))
    monkeypatch.setattr(os, "open", watched(os.open))
    return names


@pytest.fixture
def folders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Shipped profiles, a user's session beside them, and a secret outside both."""
    shipped = tmp_path / "profiles" / "vehicles"
    shipped.mkdir(parents=True)
    (tmp_path / "secret.yaml").write_text(OUTSIDE)
    (shipped / "linked.yaml").symlink_to(tmp_path / "secret.yaml")
    (shipped / "loop.yaml").symlink_to(shipped / "loop.yaml")
    own = tmp_path / "own"
    own.mkdir()
    (own / "linked.yaml").symlink_to(tmp_path / "secret.yaml")
    (own / "linked").symlink_to(tmp_path)
    monkeypatch.setattr(profile_files, "profiles_folder", lambda: tmp_path / "profiles")
    return tmp_path


NAMES = ["../../x", "../secret", "..", ".", "/etc/passwd", "linked", "loop", "a\0b", "x" * 300, "", "a\nb", "~", "a\\b"]


@pytest.mark.fault("F01")
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("inside_a_profile", [False, True])
def test_f01_name_that_leaves_the_profile_folder(
    folders: Path, opened: list[str], name: str, inside_a_profile: bool
) -> None:
    referrer = folders / "own" / "session.yaml" if inside_a_profile else None
    with pytest.raises(ProfileError, match=r"^[^\n]*: vehicles profile: value [^\n]*$") as caught:
        profile_files.load("vehicles", name, Tyre, referrer=referrer)
    assert len(str(caught.value)) < 400
    assert opened == []


REFERENCES = [
    "../secret.yaml",
    "./../secret.yaml",
    "linked.yaml",
    "linked/secret.yaml",
    "/etc/passwd.yaml",
    "~/secret.yaml",
    "x" * 300 + ".yaml",
    "../secret.yaml\0.yaml",
]


@pytest.mark.fault("F01")
@pytest.mark.parametrize("reference", REFERENCES)
def test_f01_reference_from_a_profile_stays_in_its_folder(folders: Path, opened: list[str], reference: str) -> None:
    session = folders / "own" / "session.yaml"
    with pytest.raises(ProfileError, match=r"session\.yaml: vehicles profile: value [^\n]*$"):
        profile_files.load("vehicles", reference, Tyre, referrer=session)
    absolute = str(folders / "secret.yaml")
    with pytest.raises(ProfileError, match=r"a bare name or a file inside "):
        profile_files.load("vehicles", absolute, Tyre, referrer=session)
    assert opened == []


@pytest.mark.fault("F01")
def test_f01_only_regular_files_are_opened(folders: Path, opened: list[str]) -> None:
    os.mkfifo(folders / "pipe.yaml")
    (folders / "folder.yaml").mkdir()
    for name in ("pipe.yaml", "folder.yaml"):
        with pytest.raises(ProfileError, match=r"a file that exists$"):
            profile_files.load("vehicles", str(folders / name), Tyre)
    assert opened == []
    profile_files.load("vehicles", str(folders / "secret.yaml"), Tyre)
    assert opened == [str(folders / "secret.yaml")], "the watch itself must see what is opened"


BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{b}: &{b} [{', '.join([f'*{a}'] * 9)}]\n" for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)
YAML_ATTACKS = [
    pytest.param(BOMB, "line 1: anchor &a is not allowed", id="bomb"),
    pytest.param("a: *a\n", "line 1: alias \\*a is not allowed", id="alias"),
    pytest.param(
        "a: !!python/object/apply:os.system [id]\n", "line 1: tag .*os.system is not allowed", id="python-tag"
    ),
    pytest.param("a: !secret x\n", "line 1: tag !secret is not allowed", id="own-tag"),
    pytest.param("!!python/name:os.system : 1\n", "line 1: a key that is not plain text", id="tagged-key"),
    pytest.param("[" * 20_000, "line 1: nesting deeper than 32", id="brackets"),
    pytest.param("{a: " * 20_000, "line 1: nesting deeper than 32", id="braces"),
    pytest.param("- " * 20_000, "line 1: nesting deeper than 32", id="dashes"),
    pytest.param("friction: 0.5 #" + "x" * 262_144, "file: value larger than 262144 bytes", id="size"),
    pytest.param("friction: 0.5\nfriction: 0.6\n", "line 2: key 'friction' a second time", id="twice"),
]


@pytest.mark.fault("F02")
@pytest.mark.parametrize(("text", "message"), YAML_ATTACKS)
def test_f02_yaml_that_attacks_the_reader(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "attack.yaml"
    path.write_text(text)
    began_s = process_time()
    with pytest.raises(ProfileError, match=rf"attack\.yaml: {message}[^\n]*$"):
        profile_files.load("vehicles", str(path), Tyre)
    assert process_time() - began_s < 5.0, "the cost of refusing must not grow with the attack"


@pytest.mark.fault("F03")
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("front: {mass_kg: -20}", "front.mass_kg: value -20: a number, above 0 and 100 or less"),
        ("front: {mass_kg: 20000}", "front.mass_kg: value 20000: a number, above 0 and 100 or less"),
        ("front: {friction: .nan}", "front.friction: value .nan: a finite number"),
        ("front: {friction: .inf}", "front.friction: value .inf: a finite number"),
        ("front: {friction: 1e999}", "front.friction: value 1e999: a finite number"),
        ("front: {friction: '0.9'}", 'front.friction: value "0.9": a number from 0.05 to 1.5'),
        ("front: {friction: true}", "front.friction: value true: a number from 0.05 to 1.5"),
        ("track_m: 1500", "track_m: value 1500: a number from 0.5 to 3"),
        ("track_m: 1,5", 'track_m: value "1,5": a number from 0.5 to 3'),
        ("track_m:", "track_m: value null: a number from 0.5 to 3"),
    ],
)
def test_f03_value_out_of_its_bounds(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "car.yaml"
    path.write_text(text)
    with pytest.raises(ProfileError) as caught:
        profile_files.load("vehicles", str(path), Car)
    assert str(caught.value) == f"{path}: {message}"
    assert caught.value.exit_code == 2


@pytest.mark.fault("F04")
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("trak_m: 1.5", "trak_m: value 1.5: unknown key, did you mean track_m?"),
        ("track: 1.5", "track: value 1.5: unknown key, did you mean track_m?"),
        ("front: {mass: 20}", "front.mass: value 20: unknown key, did you mean mass_kg?"),
        ("front: {Friction: 1}", "front.Friction: value 1: unknown key, did you mean friction?"),
        ("zzz: 1", "zzz: value 1: unknown key, one of front, track_m"),
    ],
)
def test_f04_unknown_key_suggests_the_near_name(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "car.yaml"
    path.write_text(text)
    with pytest.raises(ProfileError) as caught:
        profile_files.load("vehicles", str(path), Car)
    assert str(caught.value) == f"{path}: {message}"
