"""Every key of every file has a description that says more than its name."""

import re

import msgspec
import pytest

from simconsole.profiles.control import ControlProfile
from simconsole.profiles.faults import Noise
from simconsole.profiles.keys.catalogue import Key, catalogue
from simconsole.profiles.keys.descriptions import about, described
from simconsole.profiles.keys.kinds import KINDS
from simconsole.profiles.validation import ProfileName
from simconsole.recording.bundles.manifest import Manifest
from simconsole.recording.bundles.signing import Signature
from tests.sources import modules

FEWEST_WORDS = 3
EMPTY = {"a", "an", "the", "of", "and", "or", "in", "its", "it", "is", "for"}


def says_nothing(name: str, text: str) -> bool:
    """Whether a description only repeats the name of its key."""
    words = set(re.findall(r"[a-z0-9]+", text.lower())) - EMPTY
    return len(text.split()) < FEWEST_WORDS or words <= set(name.lower().split("_"))


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_is_described(kind: str) -> None:
    keys = [key for key in catalogue() if key.kind == kind]
    assert keys
    assert [key.path for key in keys if says_nothing(key.name, key.description)] == []


@pytest.mark.parametrize("record", [Manifest, Signature])
def test_every_key_of_a_bundles_files_is_described(record: type[msgspec.Struct]) -> None:
    texts = described(record)
    assert [name for name in record.__struct_fields__ if says_nothing(name, texts.get(name, ""))] == []


def test_a_description_is_a_sentence_or_several() -> None:
    assert [key.path for key in catalogue() if not re.match(r"[A-Z`].*\.$", key.description)] == []


@pytest.mark.parametrize("text", ["", "Brake.", "The brake force", "Of the brake and force."])
def test_a_text_that_repeats_the_name_says_nothing(text: str) -> None:
    assert says_nothing("brake_force", text)


def test_a_description_says_no_name_of_a_key_that_is_not_there() -> None:
    """A key that is renamed takes the texts that name it with it."""
    known = {word for key in catalogue() for word in re.findall(r"\w+", f"{key.path} {key.bounds}")}
    named = {(key.path, word) for key in catalogue() for word in _words_like_keys(key)}
    sources = {word for path in modules().values() for word in re.findall(r"\w+", path.read_text("utf-8"))}
    assert {(path, word) for path, word in named if word not in known and word not in sources} == set()
    assert "steering_override_deg" in known


def _words_like_keys(key: Key) -> list[str]:
    """Return the words in back quotes that look like names: `lock_share`, `outputs.can`."""
    return [
        word
        for quoted in re.findall(r"`([a-z_.0-9]+)`", key.description)
        for word in quoted.split(".")
        if word and not word.isdigit()
    ]


def test_inherited_fields_have_the_text_of_their_base() -> None:
    assert described(Noise)["at_s"] == "Begin at this simulated time since the start of the drive."
    assert described(Noise)["seed"].startswith("Number that the noise")


def test_a_text_of_several_lines_is_one() -> None:
    assert "\n" not in "".join(described(ControlProfile).values())
    assert about(ControlProfile).startswith("Settings of arbitration and gate")


def test_a_field_without_a_text_has_none() -> None:
    class Bare(msgspec.Struct):
        name: ProfileName

    assert described(Bare) == {}
