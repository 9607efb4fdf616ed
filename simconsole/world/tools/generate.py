"""Write a world from its plan: `python -m simconsole.world.tools.generate PLAN.yaml WORLD.yaml` (shell)."""

import json
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import msgspec

from simconsole.profiles.course_plan import CoursePlan
from simconsole.profiles.files.loader import load
from simconsole.profiles.world import CourseProfile, WorldSection
from simconsole.values.errors import ProfileError, SimConsoleError
from simconsole.world.planning import PLACES_M, PLACES_RAD, solve


def generate(plan_path: str, world_path: str) -> CourseProfile:
    """Read a plan, solve it, write the world; equal plans give equal bytes.

    Raises ProfileError for a plan that cannot be read or solved and for a file that cannot be written.
    """
    name = Path(plan_path).name
    world = solve(load("worlds", plan_path, CoursePlan), name)
    try:
        Path(world_path).write_text(to_text(world, name), encoding="utf-8", newline="\n")
    except OSError as error:
        raise ProfileError(f"{world_path}: file: {error.strerror}: a folder that can be written to") from error
    return world


def to_text(world: CourseProfile, plan_name: str) -> str:
    """Return the world as YAML, one part per line."""
    return "\n".join((*_lines(world, plan_name), ""))


def _lines(world: CourseProfile, plan_name: str) -> Iterator[str]:
    yield f"# Generated from {plan_name} by simconsole.world.tools.generate; edit the plan instead."
    for key in CourseProfile.__struct_fields__:
        value = getattr(world, key)
        if value is None:  # a part that the plan does not have
            continue
        if not isinstance(value, tuple):
            yield f"{key}: {json.dumps(value)}"
            continue
        yield f"{key}:" if value else f"{key}: []"
        for part in value:
            yield f"  - {_flow(part)}"


def _flow(part: WorldSection) -> str:
    pairs = msgspec.structs.asdict(part).items()
    return "{" + ", ".join(f"{key}: {_value(key, value)}" for key, value in pairs) + "}"


def _value(key: str, value: object) -> str:
    if not isinstance(value, float):
        return json.dumps(value)
    places = PLACES_M if key.endswith("_m") else PLACES_RAD
    text = f"{value + 0.0:.{places}f}".rstrip("0")  # + 0.0 turns -0.0 into 0.0
    return text + "0" if text.endswith(".") else text


def main(arguments: Sequence[str]) -> int:
    """Run the command; return its exit code."""
    if len(arguments) != 2:
        print("usage: python -m simconsole.world.tools.generate PLAN.yaml WORLD.yaml", file=sys.stderr)
        return 2
    try:
        world = generate(*arguments)
    except SimConsoleError as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    print(f"{arguments[1]}: {world.length_m:.1f} m, {len(world.path)} pieces")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
