"""Frame rate and processor time of the driver's view, beside a loop that only clears and finishes, in one run.

Run: python benchmarks/driver_view.py [--frames N] [--size WxH ...] [--rich]
The urban course is driven 0.35 m a frame. "calls" is the time of the thread that draws until all calls are made; the
frame itself may be drawn by other threads of the driver, or by a graphics card. "python" is what is left of it without
the draw calls themselves, in which a driver in software transforms all vertices. Without --rich no mirrors, no shadows.
"""

import argparse
import time
from collections.abc import Callable
from statistics import median
from typing import Any, NamedTuple

import moderngl

from simconsole.hud.driver_view.motion import ShownVehicle
from simconsole.hud.gl.cockpit_picture import CockpitPicture
from simconsole.hud.gl.context import renderer_name, windowless_context
from simconsole.hud.screen import Screen, fit
from simconsole.hud.view import HudView
from simconsole.profiles.view import DriverViewProfile
from simconsole.session.resolution import load_session, resolve
from simconsole.session.view.view_job import view_job
from simconsole.world.kinds.worlds import open_world

WARM_UP = 10
STEP_M = 0.35
TURNS = 5


class Cost(NamedTuple):
    """Of a frame: by the clock, of all threads, of the drawing thread until its calls are made, and without these."""

    wall_ms: float
    process_ms: float
    calls_ms: float
    python_ms: float


class DrawCalls:
    """The processor time of the thread inside the draw calls of OpenGL."""

    def __init__(self) -> None:
        self.spent_s = 0.0
        render = moderngl.VertexArray.render

        def timed(array: moderngl.VertexArray, *args: Any, **named: Any) -> None:
            before_s = time.thread_time()
            render(array, *args, **named)
            self.spent_s += time.thread_time() - before_s

        moderngl.VertexArray.render = timed  # type: ignore[assignment,method-assign]


def cost(
    context: moderngl.Context, draw_calls: DrawCalls, draw: Callable[[int], None], first: int, frames: int
) -> Cost:
    """Return what each of some frames costs."""
    calls_s, draw_calls.spent_s = 0.0, 0.0
    wall_s, process_s = time.perf_counter(), time.process_time()
    for frame in range(first, first + frames):
        before_s = time.thread_time()
        draw(frame)
        calls_s += time.thread_time() - before_s
        context.finish()
    per_ms = 1e3 / frames
    spent_s = time.perf_counter() - wall_s, time.process_time() - process_s, calls_s, calls_s - draw_calls.spent_s
    return Cost(*(per_ms * each_s for each_s in spent_s))


def measured(
    draw_calls: DrawCalls, size: tuple[int, int], frames: int, *, rich: bool, mirrors: bool
) -> tuple[Cost, Cost]:
    """Return the median cost of a frame, and of clearing one, taken in turns."""
    resolved = resolve(load_session("demo"))
    job, course = view_job(resolved), open_world(resolved.world).route
    context = windowless_context()
    profile = DriverViewProfile(always_rich=rich, mirrors=mirrors)
    picture = CockpitPicture(
        context,
        job.scene(),
        profile,
        fit(Screen(*size, 1.6, 2.2, has_view=True), *size),
        job.steering_ratio,
    )
    target = context.simple_framebuffer(size, components=3)

    def draw(frame: int) -> None:
        at = course.at(STEP_M * frame % course.length_m)
        shown = ShownVehicle(t_s=frame / 60.0, x_m=at.x_m, y_m=at.y_m, yaw_rad=at.yaw_rad)
        picture.draw(target, shown, HudView(shown_kmh=30 + frame // 12 % 30, engine_running=True, rpm=2000.0))

    def clear(frame: int) -> None:
        target.clear(0.01 * (frame % 100), 0.0, 0.0, depth=1.0)

    cost(context, draw_calls, draw, 0, WARM_UP)
    part = max(1, frames // TURNS)
    turns = [
        (cost(context, draw_calls, draw, turn * part, part), cost(context, draw_calls, clear, 0, part))
        for turn in range(TURNS)
    ]
    found = [Cost(*(median(values) for values in zip(*kind, strict=True))) for kind in zip(*turns, strict=True)]
    print(f"{renderer_name(context)}, {size[0]}x{size[1]}, {'rich' if rich else 'plain'}, mirrors {mirrors}")
    for name, each in zip(("frame", "clear only"), found, strict=True):
        print(
            f"  {name:<10} {1e3 / each.wall_ms:7.1f} fps  {each.wall_ms:6.2f} ms by the clock  "
            f"{each.process_ms:6.2f} ms processor  {each.calls_ms:5.2f} ms calls  {each.python_ms:5.2f} ms python"
        )
    context.release()
    return found[0], found[1]


def main() -> None:
    """Print what is measured."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--size", action="append", metavar="WxH")
    parser.add_argument("--rich", action="store_true", help="mirrors, shadows and smooth edges, whatever draws")
    options = parser.parse_args()
    draw_calls = DrawCalls()
    for text in options.size or ("640x480", "1400x1050"):
        width, height = (int(number) for number in text.split("x"))
        plain, _ = measured(draw_calls, (width, height), options.frames, rich=options.rich, mirrors=False)
        if options.rich:
            all_three, _ = measured(draw_calls, (width, height), options.frames, rich=True, mirrors=True)
            print(
                f"  a mirror: {(all_three.calls_ms - plain.calls_ms) / 3.0:.2f} ms calls, "
                f"{(all_three.python_ms - plain.python_ms) / 3.0:.2f} ms python"
            )


if __name__ == "__main__":
    main()
