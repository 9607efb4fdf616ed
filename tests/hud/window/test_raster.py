from pathlib import Path

import numpy as np
import pygame
import pytest
from numpy.typing import NDArray

from simconsole.hud.draw import (
    Arc,
    Box,
    DrawItem,
    Polygon,
    Rect,
    Text,
    around,
    bounds,
    contrast,
)
from simconsole.hud.layout import layout, sample_views
from simconsole.hud.screen import Screen
from simconsole.hud.view import HudView
from simconsole.hud.window.raster import Painter, render, render_png, snapshot_png
from simconsole.values.labels import mode_label
from simconsole.values.signals import Mode
from simconsole.values.state_vector import PLATFORM_AT, Snapshot

SCREEN = Screen(1400, 1050, 1.6, 2.2)
TRIPLE = Screen(4200, 1050, 4.8, 2.2)
RED, BLACK = (250, 0, 0), (0, 0, 0)


def states() -> dict[str, HudView]:
    """One picture of each kind: every mode, both take-over stages in both halves of the flash, a refusal, no data."""
    base = HudView(shown_kmh=37, rpm=3200.0, gear="2", throttle=0.4, engine_running=True, link_age_s=0.02)
    found = {m.name: base._replace(mode=float(m), mode_label=mode_label(m), reason_label="driver asked") for m in Mode}
    asked = found["TAKEOVER_REQUESTED"]._replace(remaining_s=6.0)
    found["stage 1"] = asked._replace(takeover_stage=1)
    found["stage 2"] = asked._replace(takeover_stage=2, t_s=0.0)
    found["stage 2 inverted"] = asked._replace(takeover_stage=2, t_s=0.3)
    found["refused"] = found["MANUAL"]._replace(refusal_label="refused: too fast", rpm=6500.0)
    found["devices lost"] = base._replace(wheel_validity=4.0, pedals_validity=3.0, handbrake=1.0, link_age_s=None)
    found["no data"] = base._replace(stale=True)
    return found


def pixels(surface: pygame.Surface) -> NDArray[np.uint8]:
    return pygame.surfarray.array3d(surface).swapaxes(0, 1)


def packed(picture: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """One number for each pixel, 0xRRGGBB."""
    codes = picture[..., 0].astype(np.uint32)
    for channel in (1, 2):
        codes <<= 8
        codes |= picture[..., channel]
    return codes


@pytest.fixture(scope="module")
def painter() -> Painter:
    return Painter()


@pytest.mark.parametrize("name", states())
def test_every_text_reaches_seven_to_one_in_the_picture(name: str, painter: Painter) -> None:
    shown = states()[name]
    picture = pixels(render(shown, SCREEN, painter))
    measured = 0
    for item in layout(shown, SCREEN):
        if not isinstance(item, Text) or item.text == "-" or item.text == "--":
            continue
        box = bounds(item)
        part = picture[int(box.y) - 2 : int(box.bottom) + 3, int(box.x) - 2 : int(box.right) + 3]
        codes, counts = np.unique(packed(part), return_counts=True)
        colours = [(int(code) >> 16, int(code) >> 8 & 255, int(code) & 255) for code in codes]
        ground = colours[counts.argmax()]
        ink = max(colours, key=lambda colour: contrast(colour, ground))
        assert contrast(item.colour, ground) >= 7.0, (item, ground)
        assert contrast(ink, ground) >= 7.0, (item, ground, ink)
        measured += 1
    assert measured > 20


@pytest.mark.parametrize("screen", [SCREEN, Screen(1920, 1080, 1.6, 2.0), TRIPLE], ids=["4:3", "16:9", "triple"])
def test_a_png_of_every_size_is_written(screen: Screen, tmp_path: Path, painter: Painter) -> None:
    path = tmp_path / "hud.png"
    render_png(states()["stage 1"], path, screen)
    picture = pygame.image.load(path)
    assert picture.get_size() == (screen.width_px, screen.height_px)
    content = pixels(picture)
    assert len(np.unique(packed(content))) > 50
    left = int(0.05 * screen.width_px) - 1
    top = int(0.05 * screen.height_px) - 1
    # The border stays empty in the picture too, smoothed edges included.
    for strip in (content[:top], content[-top:], content[:, :left], content[:, -left:]):
        assert (strip == content[0, 0]).all()


def test_every_state_has_a_picture_of_its_own(painter: Painter) -> None:
    pictures = {name: pixels(render(shown, SCREEN, painter)).tobytes() for name, shown in states().items()}
    assert len(set(pictures.values())) == len(pictures)


def test_a_snapshot_becomes_a_png(tmp_path: Path) -> None:
    snapshot_png(Snapshot(5, 250, np.zeros(PLATFORM_AT)), tmp_path / "fresh.png")
    snapshot_png(Snapshot(5, 250, np.zeros(PLATFORM_AT)), tmp_path / "stale.png", age_s=1.0)
    assert (tmp_path / "fresh.png").read_bytes() != (tmp_path / "stale.png").read_bytes()


def test_a_painter_draws_the_same_picture_again(painter: Painter) -> None:
    shown = states()["AUTONOMOUS"]
    first = pixels(render(shown, SCREEN, painter)).tobytes()
    for other in states().values():
        render(other, SCREEN, painter)
    assert pixels(render(shown, SCREEN, painter)).tobytes() == first
    assert pixels(render(shown, SCREEN)).tobytes() == first


def test_repainting_what_changed_gives_the_whole_picture(painter: Painter) -> None:
    rng = np.random.default_rng(11)
    kinds = list(states().values())
    shown = kinds[0]
    surface, before = pygame.Surface((SCREEN.width_px, SCREEN.height_px)), list[DrawItem]()
    for _ in range(30):
        shown = kinds[rng.integers(len(kinds))] if rng.random() < 0.4 else shown
        shown = shown._replace(rpm=float(rng.uniform(0, 7500)), throttle=float(rng.random()), t_s=float(rng.random()))
        after = layout(shown, SCREEN)
        painter.repaint(surface, before, after)
        before = after
        assert (pixels(surface) == pixels(render(shown, SCREEN, painter))).all(), f"seed 11, {shown}"


def test_a_moving_needle_repaints_a_small_part(painter: Painter) -> None:
    surface = pygame.Surface((SCREEN.width_px, SCREEN.height_px))
    one, other = (layout(states()["MANUAL"]._replace(rpm=rpm), SCREEN) for rpm in (3200.0, 3230.0))
    painter.paint(surface, one)
    areas = painter.repaint(surface, one, other)
    assert sum(area.w * area.h for area in areas) < 0.2 * SCREEN.width_px * SCREEN.height_px
    assert painter.repaint(surface, other, other) == []


def drawn(item: Rect | Polygon | Arc | Text) -> NDArray[np.bool_]:
    surface = pygame.Surface((400, 300))
    surface.fill(BLACK)
    Painter().paint(surface, [item])
    return pixels(surface)[:, :, 0] > 120


def test_the_dots_of_a_capital_do_not_push_the_word_down() -> None:
    plain, dotted = (drawn(Text(200.0, 150.0, text, 22.0, RED, "x")) for text in ("NEHMEN", "NEHMENÜ"))
    assert np.flatnonzero(plain.any(axis=1))[-1] == np.flatnonzero(dotted[:, :240].any(axis=1))[-1]
    assert np.flatnonzero(dotted.any(axis=1))[0] < np.flatnonzero(plain.any(axis=1))[0] - 3


@pytest.mark.parametrize("anchor", ["l", "c", "r"])
@pytest.mark.parametrize(
    "text",
    ["H", "MANUAL", "refused: brake is pressed", "0123456789", "x1000 rpm", "100 %", "Lenkrad anschließen", "30° L"],
)
def test_words_are_where_and_as_large_as_the_draw_list_says(text: str, anchor: str) -> None:
    item = Text({"l": 20.0, "c": 200.0, "r": 380.0}[anchor], 150.0, text, 22.0, RED, "x", anchor)
    mask = drawn(item)
    columns, rows = np.flatnonzero(mask.any(axis=0)), np.flatnonzero(mask.any(axis=1))
    box = bounds(item)
    # Letters have a little room before and behind them.
    assert -1 <= columns[0] - box.x <= 4
    assert -1 <= box.right - columns[-1] <= 4
    assert abs(rows[0] - box.y) <= 2
    if text.isupper():
        assert abs(rows[-1] + 1 - box.bottom) <= 1.5
        assert rows[-1] + 1 - rows[0] >= 21


def test_shapes_cover_their_own_place_and_nothing_else() -> None:
    for item in (
        Rect(Box(50.0, 60.0, 100.0, 80.0), RED, "x"),
        Rect(Box(50.0, 60.0, 100.0, 80.0), RED, "x", 20.0),
        Rect(Box(50.0, 60.0, 100.0, 80.0), RED, "x", 20.0, 6.0),
        Polygon(around(120.0, 130.0, 60.0, 6), RED, "x"),
        Polygon(around(120.0, 130.0, 60.0, 3), RED, "x", 4.0),
        Arc(150.0, 150.0, 80.0, 60.0, -130.0, 40.0, RED, "x"),
        Arc(150.0, 150.0, 80.0, 0.0, 0.0, 360.0, RED, "x"),
    ):
        mask = drawn(item)
        columns, rows = np.flatnonzero(mask.any(axis=0)), np.flatnonzero(mask.any(axis=1))
        box = bounds(item)
        assert columns[0] >= box.x - 2
        assert columns[-1] <= box.right + 2
        assert rows[0] >= box.y - 2
        assert rows[-1] <= box.bottom + 2
        assert mask.any()


def test_areas_are_right() -> None:
    disc = drawn(Arc(150.0, 150.0, 80.0, 0.0, 0.0, 360.0, RED, "x")).sum()
    assert disc == pytest.approx(np.pi * 80**2, rel=0.01)
    ring = drawn(Arc(150.0, 150.0, 80.0, 60.0, 0.0, 90.0, RED, "x")).sum()
    assert ring == pytest.approx(np.pi * (80**2 - 60**2) / 4, rel=0.03)
    rounded = drawn(Rect(Box(50.0, 60.0, 100.0, 80.0), RED, "x", 20.0)).sum()
    assert rounded == pytest.approx(100 * 80 - (4 - np.pi) * 20**2, rel=0.01)


def test_sample_views_can_all_be_drawn(painter: Painter) -> None:
    small = Screen(700, 525, 1.6, 1.1)
    for shown in sample_views():
        assert pixels(render(shown, small, painter)).std() > 10.0


def test_fonts_of_every_size_keep_no_file_open() -> None:
    before = len(list(Path("/proc/self/fd").iterdir()))
    fresh = Painter()
    for screen in (SCREEN, TRIPLE):
        for view in states().values():
            fresh.paint(pygame.Surface((screen.width_px, screen.height_px)), layout(view, screen))
    assert len(fresh._fonts) > 5
    assert len(list(Path("/proc/self/fd").iterdir())) == before
