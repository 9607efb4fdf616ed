import pytest

from simconsole.profiles.keys.kinds import KINDS, PAGES, page_of
from tests.paths import ROOT


@pytest.mark.parametrize(
    ("kind", "keys", "page"),
    [
        ("session", "outputs.bridge.link.delay_ms", "docs/tracking.md"),
        ("session", "outputs.bridge.port", "docs/rosbridge.md"),
        ("session", "outputs.hud", "docs/operators.md"),
        ("session", "scenario.faults[].at_s", "docs/faults.md"),
        ("session", "outputsx", "docs/own/session.md"),
        ("scenario", "session.outputs.can", "docs/can.md"),
        ("scenario", "manoeuvre", "docs/handling.md"),
        ("scenario", "golden_hz", "docs/scenarios.md"),
        ("vehicle", "manoeuvre", "docs/own/vehicle.md"),
    ],
)
def test_the_narrowest_page_tells_of_a_key(kind: str, keys: str, page: str) -> None:
    assert page_of(kind, keys) == page


def test_every_page_is_there() -> None:
    pages = {*PAGES.values(), *(kind.page for kind in KINDS.values())}
    assert [page for page in sorted(pages) if not (ROOT / page).is_file()] == []
