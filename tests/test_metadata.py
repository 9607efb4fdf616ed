"""The package's metadata: its address and its links are those of the clone that it is built in."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.paths import ROOT

FILES = ("pyproject.toml", "README.md", "LICENSE", "scripts/metadata.py", "simconsole/values/version.py")
"""What the metadata are made of."""
ADDRESS = "https://git.example.org/lab/simconsole"
PLACEHOLDER = "ADDRESS"

MetadataOf = Callable[[str | None], dict[str, Any]]
"""Return the metadata that are built in a checkout with this remote `origin`; None for none."""


@pytest.fixture
def metadata_of(tmp_path: Path) -> MetadataOf:
    def built(origin: str | None) -> dict[str, Any]:
        for name in FILES:
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_bytes((ROOT / name).read_bytes())
        subprocess.run(["git", "init", "--quiet", tmp_path], check=True)
        if origin is not None:
            subprocess.run(["git", "-C", tmp_path, "remote", "add", "origin", origin], check=True)
        return hatched(tmp_path)

    return built


def hatched(folder: Path) -> dict[str, Any]:
    command = [sys.executable, "-m", "hatchling", "metadata", "--compact"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize(
    "origin",
    [
        ADDRESS,
        f"{ADDRESS}.git",
        f"{ADDRESS}/",
        "https://somebody:a-token@git.example.org/lab/simconsole.git",
        "git@git.example.org:lab/simconsole.git",
        "ssh://git@git.example.org:2222/lab/simconsole.git",
    ],
)
def test_a_clone_of_a_host_gives_its_address(origin: str, metadata_of: MetadataOf) -> None:
    metadata = metadata_of(origin)
    assert metadata["urls"]["Repository"] == ADDRESS
    assert set(metadata["urls"]) == {"Repository", "Documentation", "Changelog", "Issues"}
    assert all(url.startswith(ADDRESS) for url in metadata["urls"].values())
    assert "token" not in json.dumps(metadata)


def test_all_links_of_the_description_are_absolute_and_lead_to_files_that_are_there(metadata_of: MetadataOf) -> None:
    text = metadata_of(ADDRESS)["readme"]["text"]
    links = re.findall(r"\]\(([^)]+)\)", text)
    assert len(links) >= 15
    for link in links:
        assert re.match(r"https?://", link), link
        if link.startswith(ADDRESS):
            kind, _, path = link.removeprefix(f"{ADDRESS}/").partition("/HEAD/")
            assert (ROOT / path).is_file(), link
            assert kind == ("raw" if path.endswith((".png", ".webp", ".mp4")) else "blob")
    assert f"$ git clone {ADDRESS} simconsole && cd simconsole\n" in text
    assert PLACEHOLDER not in text


@pytest.mark.parametrize(
    "origin", [None, "/srv/git/simconsole.git", "file:///srv/git/x", "nas:git/x", "http://127.0.0.1/x"]
)
def test_what_others_cannot_reach_is_no_address(origin: str | None, metadata_of: MetadataOf) -> None:
    metadata = metadata_of(origin)
    assert not metadata.get("urls")
    assert metadata["readme"]["text"] == (ROOT / "README.md").read_text()


def test_a_folder_within_another_checkout_has_no_address(metadata_of: MetadataOf, tmp_path: Path) -> None:
    metadata_of(ADDRESS)
    inner = tmp_path / "vendored"
    for name in FILES:
        (inner / name).parent.mkdir(parents=True, exist_ok=True)
        (inner / name).write_bytes((ROOT / name).read_bytes())
    assert not hatched(inner).get("urls")
