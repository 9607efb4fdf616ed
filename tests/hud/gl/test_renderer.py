import math

import numpy as np
import pytest

from simconsole.hud.driver_view.camera import Camera, Lens, Viewport, rotation, to_pixels
from simconsole.hud.driver_view.light import DAY, NIGHT
from simconsole.hud.driver_view.mesh import Box, Material, box, joined
from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.driver_view.scene import Pieces, ViewScene, pieces, view_scene
from simconsole.hud.driver_view.vehicle_body import Size
from simconsole.hud.driver_view.views import Look
from simconsole.hud.gl.renderer import Quality, Renderer
from simconsole.world.drawing import Drawing
from simconsole.world.drawing_layers import Light, LightProgram
from simconsole.world.roads.running import Running
from simconsole.world.traffic.road_users import RoadUser
from tests.hud.gl.pictures import Pixels, context, pixels, target
from tests.samples import Sample

SIZE = Size(3.99, 1.75, 1.45, 0.75, 2.5)
WIDTH_PX, HEIGHT_PX = 640, 400
RED = (255, 0, 0)


def drawn(scene: ViewScene, look: Look, shown: ShownVehicle | None = None, quality: Quality | None = None) -> Pixels:
    framebuffer = target(WIDTH_PX, HEIGHT_PX)
    Renderer(context(), scene, DAY, quality or Quality(), 15.0).draw(
        framebuffer, [look], shown or ShownVehicle(x_m=-500.0)
    )
    return pixels(framebuffer)


def redness(picture: Pixels) -> np.ndarray:
    picture = picture.astype(int)
    return (picture[..., 0] > 120) & (picture[..., 1] < 60) & (picture[..., 2] < 60)


@pytest.mark.parametrize("mirror", [False, True])
def test_a_mark_lands_within_a_pixel_of_where_it_should(mirror: bool, sample: Sample) -> None:
    """A small glowing cube anywhere in sight: the middle of its pixels against the projection by numpy alone."""
    generator = np.random.Generator(np.random.PCG64(sample.seed))
    empty = view_scene(None, (), SIZE)
    for _ in range(sample.of(12, 300)):
        eye = np.array((*generator.uniform(-40.0, 40.0, 2), generator.uniform(0.9, 3.0)))
        axes = rotation(generator.uniform(-math.pi, math.pi), generator.normal(0.0, 0.05), generator.normal(0.0, 0.05))
        lens = Lens(generator.uniform(0.4, 1.6), WIDTH_PX / HEIGHT_PX, generator.uniform(0.4, 0.6), mirror)
        away = generator.uniform(8.0, 40.0)
        aside = 0.35 * math.tan(0.5 * lens.horizontal_fov_rad) * generator.uniform(-1.0, 1.0, 2)
        middle = eye + axes @ (away * np.array((1.0, aside[0], 0.5 * aside[1])))
        half = 0.006 * away * math.tan(0.5 * lens.horizontal_fov_rad)
        cube = box(Box(middle[0], middle[1], middle[2] - half, half, half, 2.0 * half), RED, RED, Material.GLOWING)
        scene = empty._replace(layers=(), solids=pieces(joined([cube])))
        camera = Camera(eye, axes)
        picture = redness(drawn(scene, Look(camera, lens, Viewport(), from_seat=False, is_mirror=mirror)))
        rows, columns = np.nonzero(picture)
        assert len(rows) > 0
        wanted = to_pixels(middle[None, :], camera, lens, WIDTH_PX, HEIGHT_PX)[0]
        assert np.array((columns.mean() + 0.5, rows.mean() + 0.5)) == pytest.approx(wanted, abs=1.0)


def test_what_lies_on_the_road_is_seen_whole() -> None:
    """Paint in the plane of the road: not one pixel of the layer below shows through."""
    from simconsole.hud.driver_view.mesh import quads

    def plate(half: float, colour: tuple[int, int, int]) -> Pieces:
        corners = np.array([((-half, -half, 0.0), (half, -half, 0.0), (half, half, 0.0), (-half, half, 0.0))])
        return pieces(quads(corners + np.array((200.0, 0.0, 0.0)), colour, Material.GLOWING))

    base = view_scene(None, (), SIZE)
    scene = base._replace(layers=(plate(190.0, (0, 0, 255)), plate(150.0, RED)), solids=pieces(joined([])))
    look = Look(Camera(np.array((0.0, 0.0, 6.0)), rotation(0.0)), Lens(0.9, 1.6), Viewport(), from_seat=False)
    picture = redness(drawn(scene, look))
    rows = np.nonzero(picture.any(axis=1))[0]
    middle = picture[rows[0] + 1 : rows[-1], WIDTH_PX // 2]
    assert len(middle) > 4
    assert middle.all()


def test_the_vehicle_is_outside_for_others_and_inside_for_its_driver() -> None:
    scene = view_scene(None, (), SIZE)
    shown = ShownVehicle()
    behind = Look(Camera(np.array((-9.0, 0.0, 2.5)), rotation(0.0, 0.12)), Lens(0.9, 1.6), Viewport(), from_seat=False)
    seat = Look(Camera(np.array(SIZE.eye_m), rotation(0.0)), Lens(1.0, 1.6), Viewport(), from_seat=True)
    for look in (behind, seat):
        near, far = drawn(scene, look, shown), drawn(scene, look, ShownVehicle(x_m=-500.0))
        assert (near != far).any(axis=2).mean() > 0.02


def test_the_hand_wheel_turns_left_with_the_driver() -> None:
    scene = view_scene(None, (), SIZE)
    seat = Look(Camera(np.array(SIZE.eye_m), rotation(0.0, 0.4)), Lens(1.0, 1.6), Viewport(), from_seat=True)

    def mark(road_wheel_rad: float) -> float:
        picture = drawn(scene, seat, ShownVehicle(road_wheel_rad=road_wheel_rad)).astype(int)
        amber = (picture[..., 0] > 120) & (picture[..., 1] > 60) & (picture[..., 2] < 60)
        return float(np.nonzero(amber)[1].mean())

    assert mark(0.05) < mark(0.0) < mark(-0.05)


def test_brake_lamps_and_indicators_shine() -> None:
    scene = view_scene(None, (), SIZE)
    behind = Look(Camera(np.array((-6.0, 0.0, 1.2)), rotation(0.0, 0.1)), Lens(0.8, 1.6), Viewport(), from_seat=False)
    coasting, braking = (drawn(scene, behind, ShownVehicle(brake=brake)) for brake in (0.0, 0.5))
    assert redness(braking)[(coasting != braking).any(axis=2)].sum() > 200
    plain = drawn(scene, behind, ShownVehicle(t_s=0.1))
    left = (drawn(scene, behind, ShownVehicle(t_s=0.1, turn_indicators=1.0)) != plain).any(axis=2)
    right = (drawn(scene, behind, ShownVehicle(t_s=0.1, turn_indicators=-1.0)) != plain).any(axis=2)
    assert np.nonzero(left)[1].max() < WIDTH_PX / 2 < np.nonzero(right)[1].min()
    assert (drawn(scene, behind, ShownVehicle(t_s=0.5, turn_indicators=1.0)) == plain).all()


def test_a_house_throws_its_shadow_away_from_the_sun() -> None:
    base = view_scene(None, (), SIZE)
    house = pieces(box(Box(0.0, 0.0, 0.0, 4.0, 4.0, 6.0), (200, 200, 200)))
    scene = base._replace(solids=house)
    above = Look(
        Camera(np.array((0.0, 0.0, 60.0)), rotation(0.5 * math.pi, math.radians(89.9))), Lens(0.6, 1.6), Viewport(),
        from_seat=False,
    )  # fmt: skip
    here = ShownVehicle(x_m=-45.0)
    lit = drawn(scene, above, here).astype(int).sum(axis=2)
    shaded = drawn(scene, above, here, Quality(shadows=True)).astype(int).sum(axis=2)
    rows, columns = np.nonzero(lit - shaded > 60)
    assert len(rows) > 200
    # Seen from above, north up: east is right, and the sun stands where DAY.sun points.
    away = np.array((columns.mean() - 0.5 * WIDTH_PX, 0.5 * HEIGHT_PX - rows.mean()))
    assert float(away @ np.array(DAY.sun[:2])) < 0.0


@pytest.mark.parametrize("kind", [1.0, 3.0], ids=["car", "person"])
def test_others_throw_a_shadow_too(kind: float) -> None:
    above = Look(
        Camera(np.array((0.0, 0.0, 30.0)), rotation(0.5 * math.pi, math.radians(89.9))), Lens(0.6, 1.6), Viewport(),
        from_seat=False,
    )  # fmt: skip
    long_m, wide_m = (4.4, 1.8) if kind == 1.0 else (0.5, 0.5)
    user = RoadUser(
        id=1.0, kind=kind, x_m=0.0, y_m=0.0, yaw_rad=0.3, speed_mps=0.0, length_m=long_m, width_m=wide_m, height_m=1.6
    )
    here = ShownVehicle(x_m=-45.0, others=(user,))
    scene = view_scene(None, (), SIZE)
    lit = drawn(scene, above, here).astype(int).sum(axis=2)
    shaded = drawn(scene, above, here, Quality(shadows=True)).astype(int).sum(axis=2)
    rows, columns = np.nonzero(lit - shaded > 60)
    assert len(rows) > 100
    away = np.array((columns.mean() - 0.5 * WIDTH_PX, 0.5 * HEIGHT_PX - rows.mean()))
    assert float(away @ np.array(DAY.sun[:2])) < 0.0


def test_headlights_go_up_and_down_with_the_car() -> None:
    wall = pieces(box(Box(25.0, 0.0, 0.0, 0.5, 20.0, 8.0), (200, 200, 200)))
    scene = view_scene(None, (), SIZE)._replace(solids=wall)
    level = Look(Camera(np.array((0.0, 0.0, 1.2)), rotation(0.0)), Lens(1.0, 1.6), Viewport(), from_seat=False)

    def lit_rows(pitch_rad: float) -> int:
        framebuffer = target(WIDTH_PX, HEIGHT_PX)
        shown = ShownVehicle(x_m=-4.0, pitch_rad=pitch_rad)
        Renderer(context(), scene, NIGHT, Quality(), 15.0).draw(framebuffer, [level], shown)
        middle = pixels(framebuffer)[:, WIDTH_PX // 2].astype(int).sum(axis=1)
        return int(np.nonzero(middle > 200)[0].min())

    assert lit_rows(-0.1) < lit_rows(0.0) - 20  # nose up: higher on the wall
    assert lit_rows(0.05) > lit_rows(0.0) + 10


def test_night_is_dark_but_for_the_headlights() -> None:
    scene = view_scene(None, (), SIZE)
    framebuffer = target(WIDTH_PX, HEIGHT_PX)
    seat = Look(Camera(np.array(SIZE.eye_m), rotation(0.0)), Lens(1.0, 1.6), Viewport(), from_seat=True)
    Renderer(context(), scene, NIGHT, Quality(), 15.0).draw(framebuffer, [seat], ShownVehicle())
    night = pixels(framebuffer).astype(int).sum(axis=2)
    assert night[: HEIGHT_PX // 4].mean() < 90
    assert night[int(0.55 * HEIGHT_PX) : int(0.62 * HEIGHT_PX), WIDTH_PX // 2].max() > 150


def test_a_mirror_stands_in_a_dark_frame() -> None:
    scene, camera, lens = view_scene(None, (), SIZE), Camera(np.array((0.0, 0.0, 1.2)), rotation(0.0)), Lens(0.6, 1.5)
    whole = Look(camera, Lens(1.2, 1.6), Viewport(), from_seat=True)
    mirror = Look(camera, lens._replace(is_mirror=True), Viewport(0.5, 0.5, 0.25, 0.25), from_seat=True, is_mirror=True)
    framebuffer = target(WIDTH_PX, HEIGHT_PX)
    Renderer(context(), scene, DAY, Quality(), 15.0).draw(framebuffer, [whole, mirror], ShownVehicle(x_m=-500.0))
    picture = pixels(framebuffer).astype(int)
    left, right, top, bottom = 320, 480, 100, 200
    for rim in (picture[top:bottom, left - 2 : left], picture[top:bottom, right : right + 2]):
        assert rim.max() < 30
    for rim in (picture[top - 2 : top, left:right], picture[bottom : bottom + 2, left:right]):
        assert rim.max() < 30
    assert picture[top:bottom, left:right].min(axis=(0, 1)).max() > 30
    assert picture[top:bottom, left - 8].max() > 30


def test_a_mirror_is_told_from_the_night_around_it() -> None:
    scene, camera, lens = view_scene(None, (), SIZE), Camera(np.array((0.0, 0.0, 1.2)), rotation(0.0)), Lens(0.6, 1.5)
    whole = Look(camera, Lens(1.2, 1.6), Viewport(), from_seat=True)
    mirror = Look(camera, lens._replace(is_mirror=True), Viewport(0.5, 0.6, 0.25, 0.25), from_seat=True, is_mirror=True)
    framebuffer = target(WIDTH_PX, HEIGHT_PX)
    Renderer(context(), scene, NIGHT, Quality(), 15.0).draw(framebuffer, [whole, mirror], ShownVehicle(x_m=-500.0))
    picture = pixels(framebuffer).astype(int)
    rim, around, inside = picture[100, 318:320], picture[100, 300:310], picture[100, 325:335]
    assert rim.min() > 1.5 * around.max()
    assert rim.min() > 1.5 * inside.max()


def test_other_vehicles_are_seen_where_they_are() -> None:
    scene = view_scene(None, (), SIZE)
    camera, lens = Camera(np.array((0.0, 0.0, 1.6)), rotation(0.0)), Lens(0.9, WIDTH_PX / HEIGHT_PX)
    look = Look(camera, lens, Viewport(), from_seat=False)
    user = RoadUser(
        id=1.0, kind=1.0, x_m=25.0, y_m=5.0, yaw_rad=0.3, speed_mps=0.0, length_m=4.4, width_m=1.8, height_m=1.5
    )
    alone = drawn(scene, look)
    beside = drawn(scene, look, ShownVehicle(x_m=-500.0, others=(user,)))
    far = drawn(scene, look, ShownVehicle(x_m=-500.0, others=(user._replace(x_m=1e5),)))
    rows, columns = np.nonzero((alone != beside).any(axis=2))
    wanted = to_pixels(np.array(((25.0, 5.0, 0.75),)), camera, lens, WIDTH_PX, HEIGHT_PX)[0]
    assert np.array((columns.mean(), rows.mean())) == pytest.approx(wanted, abs=12.0)
    assert np.array_equal(alone, far)


@pytest.mark.parametrize(("letter", "channel", "others"), [("r", 0, (1, 2)), ("G", 1, (0,))])
def test_lamp_that_shines_is_seen_by_those_who_come(letter: str, channel: int, others: tuple[int, ...]) -> None:
    program = LightProgram("one", 0, 0.0, (1.0,), letter)
    plain = world_parts_of_light(None)
    lit = drawn(world_parts_of_light(program), TOWARDS_LIGHT, ShownVehicle(x_m=-500.0, tick_hz=100))
    unlit = drawn(plain, TOWARDS_LIGHT, ShownVehicle(x_m=-500.0, tick_hz=100))
    changed = (lit != unlit).any(axis=2)
    assert 20 < np.count_nonzero(changed) < 2000
    colour = lit[changed].astype(int).mean(axis=0)
    assert all(colour[channel] > colour[other] + 60 for other in others)
    assert (unlit[changed].max(axis=1) < 120).mean() > 0.9


def test_another_simulators_light_shines_as_it_says() -> None:
    red, green = (LightProgram("one", 0, 0.0, (1.0,), letter) for letter in "rG")
    shown = ShownVehicle(x_m=-500.0, tick_hz=100)
    told = shown._replace(signals={"one": Running("G", (), 0, 0.0)})
    assert np.array_equal(
        drawn(world_parts_of_light(red), TOWARDS_LIGHT, told), drawn(world_parts_of_light(green), TOWARDS_LIGHT, shown)
    )


def world_parts_of_light(program: LightProgram | None) -> ViewScene:
    """A post at the origin for those who drive along x."""
    light = Light(0.0, 0.0, 0.0, program)
    path = np.array(((-50.0, 0.0), (50.0, 0.0)))
    drawing = Drawing((), (), (), (), (), (), (light,), path)
    return view_scene(drawing, (), SIZE)


TOWARDS_LIGHT = Look(
    Camera(np.array((-8.0, 0.0, 2.7)), np.eye(3)),
    Lens(0.5, WIDTH_PX / HEIGHT_PX, 0.5, False),
    Viewport(),
    from_seat=False,
    is_mirror=False,
)
