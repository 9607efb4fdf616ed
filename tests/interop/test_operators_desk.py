"""The operators' desk in a browser: rerun's viewer shows the scene of a drive that goes on."""

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from simconsole.scene.entities import BODY, MODE_COLOURS
from simconsole.scene.viewer.scene_server import SceneServer
from simconsole.values.signals import Mode
from tests.interop.browser import CHROMIUM, Page, browse
from tests.paths import ROOT
from tests.patience import wait_until
from tests.scene.viewer.viewers import live_scene

SIZE_PX = (640, 400)
NEAR = 24
"""How far a colour may be from the one meant, light and shade apart."""

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: system-packages.txt")


def share_of(colour: tuple[int, int, int], picture: np.ndarray) -> float:
    """Return the share of the pixels that have a colour's hue: its channels over their sum."""
    values = picture.astype(float) + 1e-9
    hue = values / values.sum(axis=-1, keepdims=True)
    wanted = np.array(colour, float) / sum(colour)
    return float(((np.abs(hue - wanted) < NEAR / 255.0).all(axis=-1) & (values.sum(axis=-1) > 150.0)).mean())


def picture_of(page: Page) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(page.screenshot())).convert("RGB"))


def test_the_car_and_who_drives_are_on_the_page(tmp_path: Path) -> None:
    path = tmp_path / "scene.live.rrd"
    live_scene(path, 12, ROOT)
    server = SceneServer(path)
    try:
        url = f"{server.addresses.browser}&renderer=webgl&hide_welcome_screen=1"
        with browse(url, tmp_path / "browser", *SIZE_PX) as page:

            def shown() -> bool:
                server.pump()
                picture = picture_of(page)
                autonomous = MODE_COLOURS[Mode.AUTONOMOUS]
                return share_of(BODY, picture) > 1e-4 and share_of(autonomous, picture[: SIZE_PX[1] // 3]) > 1e-3

            wait_until(shown, "car and mode lane")
    finally:
        server.close()
