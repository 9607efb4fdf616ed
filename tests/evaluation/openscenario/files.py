"""OpenSCENARIO files as scenariogeneration writes them: what is understood, and twenty with what is not."""

import random
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import pytest


def xosc() -> Any:
    """Return scenariogeneration's generators, which with scipy take a second and 60 MB to load.

    Where its libraries have no wheels (pyproject.toml) the test is skipped.
    """
    return pytest.importorskip("scenariogeneration.xosc", reason="scenariogeneration is not installed")


def dynamics(shape: str, seconds: float) -> Any:
    return xosc().TransitionDynamics(getattr(xosc().DynamicsShapes, shape), xosc().DynamicsDimension.time, seconds)


def in_a_step() -> Any:
    return dynamics("step", 0)


def linearly() -> Any:
    return dynamics("linear", 4)


def smoothly() -> Any:
    return dynamics("sinusoidal", 4)


def more() -> Any:
    return xosc().Rule.greaterThan


def less() -> Any:
    return xosc().Rule.lessThan


def at_s(value: float, point: str = "start") -> Any:
    return xosc().ValueTrigger(
        "time", 0, xosc().ConditionEdge.none, xosc().SimulationTimeCondition(value, more()), triggeringpoint=point
    )


def by(condition: Any, entity: str = "Ego", delay: float = 0) -> Any:
    return xosc().EntityTrigger("condition", delay, xosc().ConditionEdge.rising, condition, entity)


def brakes() -> Any:
    return xosc().AbsoluteSpeedAction(0, linearly())


def car(category: str = "car", name: str = "car") -> Any:
    box = xosc().BoundingBox(1.8, 4.5, 1.5, 1.4, 0, 0.75)
    front, rear = xosc().Axle(0.5, 0.6, 1.6, 2.7, 0.3), xosc().Axle(0, 0.6, 1.6, 0, 0.3)
    return xosc().Vehicle(name, getattr(xosc().VehicleCategory, category), box, front, rear, 69, 10, 10)


def walker() -> Any:
    return xosc().Pedestrian(
        "walker", 80, xosc().PedestrianCategory.pedestrian, xosc().BoundingBox(0.5, 0.4, 1.8, 0, 0, 0.9)
    )


def written(
    action: Any = None,
    trigger: Any = None,
    *,
    other: Any = None,
    place: Any = None,
    actor: str = "Lead",
    also: Any = None,
    ego: Any = None,
    act_trigger: Any = None,
    events: int = 1,
    minor: int = 3,
) -> bytes:
    """Return a file with the console's vehicle, one other, and one event of that."""
    entities = xosc().Entities()
    entities.add_scenario_object("Ego", car())
    entities.add_scenario_object("Lead", other or car())
    init = xosc().Init()
    init.add_init_action("Ego", xosc().TeleportAction(xosc().WorldPosition(0, 0, 0, 0, 0, 0)))
    init.add_init_action("Ego", xosc().AbsoluteSpeedAction(10, in_a_step()))
    init.add_init_action("Lead", xosc().TeleportAction(place or xosc().WorldPosition(40, 0, 0, 0, 0, 0)))
    init.add_init_action("Lead", xosc().AbsoluteSpeedAction(8, in_a_step()))
    if also is not None:
        init.add_init_action("Lead", also)
    if ego is not None:
        init.add_init_action("Ego", ego)
    board = xosc().StoryBoard(init, at_s(12, "stop"))
    if action is not None:
        maneuver = xosc().Maneuver("maneuver")
        for number in range(events):
            event = xosc().Event(
                f"event {number}", xosc().Priority.override if minor > 1 else xosc().Priority.overwrite
            )
            event.add_action("action", action)
            event.add_trigger(trigger or at_s(4))
            maneuver.add_event(event)
        group = xosc().ManeuverGroup("group")
        group.add_actor(actor)
        group.add_maneuver(maneuver)
        act = xosc().Act("act", act_trigger or at_s(0))
        act.add_maneuver_group(group)
        story = xosc().Story("story")
        story.add_act(act)
        board.add_story(story)
    parameters = xosc().ParameterDeclarations()
    parameters.add_parameter(xosc().Parameter("speed", xosc().ParameterType.double, "6"))
    road, catalogs = xosc().RoadNetwork(), xosc().Catalog()
    made = xosc().Scenario("a file", "nobody", parameters, entities, board, road, catalogs, osc_minor_version=minor)
    with TemporaryDirectory() as folder:
        made.write_xml(f"{folder}/made.xosc")
        return (Path(folder) / "made.xosc").read_bytes()


def trajectory(shape: Any = None, closed: bool = False, domain: str = "relative") -> Any:
    path = xosc().Trajectory("path", closed)
    places = [xosc().WorldPosition(40, 0, 0, 0), xosc().WorldPosition(60, 0, 0, 0), xosc().WorldPosition(80, 6, 0, 0.5)]
    path.add_shape(shape or xosc().Polyline([0, 2, 4], places))
    return xosc().FollowTrajectoryAction(
        path, xosc().FollowingMode.position, getattr(xosc().ReferenceContext, domain), 1, 0
    )


def nurbs() -> Any:
    shape = xosc().Nurbs(2)
    for x in (40, 60, 80):
        shape.add_control_point(xosc().ControlPoint(xosc().WorldPosition(x, 0, 0, 0), x, 0.1))
    shape.add_knots([5, 4, 3, 2, 1])
    return shape


def distance(kind: str = "euclidianDistance") -> Any:
    return xosc().RelativeDistanceCondition(
        15, less(), getattr(xosc().RelativeDistanceType, kind), "Lead", freespace=True
    )


def at_place() -> Any:
    return xosc().ReachPositionCondition(xosc().WorldPosition(70, 0), 4)


def near_place() -> Any:
    kind = xosc().RelativeDistanceType.euclidianDistance
    return xosc().DistanceCondition(4, less(), xosc().WorldPosition(70, 0), False, False, kind)


def route() -> Any:
    found = xosc().Route("way")
    found.add_waypoint(xosc().WorldPosition(0, 0), xosc().RouteStrategy.shortest)
    found.add_waypoint(xosc().WorldPosition(90, 0), xosc().RouteStrategy.shortest)
    return xosc().AssignRouteAction(found)


def switch(on: bool, longitudinal: bool | None = None) -> Any:
    return xosc().ActivateControllerAction(on, on if longitudinal is None else longitudinal)


def theirs() -> Any:
    return xosc().ControllerAction(xosc().AssignControllerAction(xosc().Controller("theirs")))


def overridden() -> Any:
    values = xosc().OverrideControllerValueAction()
    values.set_brake(True, 0.5)
    return xosc().ControllerAction(overrideControllerValueAction=values)


def two_conditions() -> Any:
    group = xosc().ConditionGroup()
    group.add_condition(by(xosc().SpeedCondition(5, more())))
    group.add_condition(by(xosc().TraveledDistanceCondition(20)))
    return group


def time_and_more() -> Any:
    group = xosc().ConditionGroup()
    group.add_condition(by(xosc().SpeedCondition(5, more())))
    group.add_condition(at_s(3))
    return group


def either() -> Any:
    trigger = xosc().Trigger()
    for seconds in (4, 6):
        group = xosc().ConditionGroup()
        group.add_condition(at_s(seconds))
        trigger.add_conditiongroup(group)
    return trigger


def state() -> Any:
    kind, at = xosc().StoryboardElementType.act, xosc().StoryboardElementState.completeState
    return xosc().StoryboardElementStateCondition(kind, "act", at)


UNDERSTOOD: Final[dict[str, Callable[[], bytes]]] = {
    "nothing happens": lambda: written(),
    "van": lambda: written(brakes(), other=car("van")),
    "pedestrian": lambda: written(brakes(), other=walker()),
    "heading": lambda: written(brakes(), place=xosc().WorldPosition(40, -5, 0, 1.2, 0, 0)),
    "speed in a step": lambda: written(xosc().AbsoluteSpeedAction(3, in_a_step())),
    "speed by time": lambda: written(brakes()),
    "speed by rate": lambda: written(
        xosc().AbsoluteSpeedAction(
            0, xosc().TransitionDynamics(xosc().DynamicsShapes.linear, xosc().DynamicsDimension.rate, 6)
        )
    ),
    "lane change": lambda: written(xosc().RelativeLaneChangeAction(1, "Lead", smoothly())),
    "lane change to the right": lambda: written(xosc().RelativeLaneChangeAction(-1, "Lead", linearly())),
    "lane offset": lambda: written(xosc().AbsoluteLaneOffsetAction(0.5, xosc().DynamicsShapes.sinusoidal, 2)),
    "trajectory": lambda: written(trajectory()),
    "own speed": lambda: written(brakes(), by(xosc().SpeedCondition(5, more()))),
    "own way": lambda: written(brakes(), by(xosc().TraveledDistanceCondition(30), delay=1)),
    "a place": lambda: written(brakes(), by(at_place(), "Lead"), minor=1),
    "a place by distance": lambda: written(brakes(), by(near_place(), "Lead")),
    "a distance": lambda: written(brakes(), by(distance())),
    "headway": lambda: written(brakes(), by(xosc().TimeHeadwayCondition("Lead", 3, less()))),
    "time to collision": lambda: written(brakes(), by(xosc().TimeToCollisionCondition(6, less(), entity="Lead"))),
    "a later act": lambda: written(brakes(), by(xosc().SpeedCondition(5, more())), act_trigger=at_s(5)),
    "a condition and a time": lambda: written(brakes(), time_and_more()),
    "truck": lambda: written(brakes(), other=car("truck")),
    "a cartesian distance": lambda: written(brakes(), by(distance())).replace(
        b"euclidianDistance", b"cartesianDistance"
    ),
    "a condition that holds at once": lambda: written(
        brakes(),
        xosc().EntityTrigger(
            "condition", 0, xosc().ConditionEdge.none, xosc().TimeHeadwayCondition("Lead", 3, less()), "Ego"
        ),
    ),
    "a controller that is switched on": lambda: written(switch(True), actor="Ego", ego=switch(False)),
    "a controller": lambda: written(also=theirs(), minor=2),
    "several events": lambda: written(brakes(), events=3),
}
"""By what it shows: files that are imported whole."""

NOT_UNDERSTOOD: Final[dict[str, tuple[str, Callable[[], bytes]]]] = {
    "a speed relative to another": (
        "RelativeTargetSpeed",
        lambda: written(xosc().RelativeSpeedAction(1, "Ego", linearly())),
    ),
    "a speed on a curve": ("SpeedActionDynamics", lambda: written(xosc().AbsoluteSpeedAction(3, smoothly()))),
    "a profile of speeds": (
        "SpeedProfileAction",
        lambda: written(xosc().SpeedProfileAction([3, 5], xosc().FollowingMode.position, [1, 2])),
    ),
    "a lane by number": ("AbsoluteTargetLane", lambda: written(xosc().AbsoluteLaneChangeAction(1, smoothly()))),
    "another one's lane": (
        "RelativeTargetLane",
        lambda: written(xosc().RelativeLaneChangeAction(1, "Ego", smoothly())),
    ),
    "a distance to hold": (
        "LongitudinalDistanceAction",
        lambda: written(xosc().LongitudinalDistanceAction("Ego", distance=20)),
    ),
    "a way": ("AssignRouteAction", lambda: written(route())),
    "a goal": ("AcquirePositionAction", lambda: written(xosc().AcquirePositionAction(xosc().WorldPosition(90, 0)))),
    "hiding": ("VisibilityAction", lambda: written(xosc().VisibilityAction(False, False, False))),
    "a spline": ("Nurbs", lambda: written(trajectory(nurbs()))),
    "a closed trajectory": ("Trajectory", lambda: written(trajectory(closed=True))),
    "a trajectory by the clock": ("Timing", lambda: written(trajectory(domain="absolute"))),
    "acts of the console's vehicle": ("EntityRef", lambda: written(brakes(), actor="Ego")),
    "a global action": ("GlobalAction", lambda: written(xosc().VariableSetAction("speed", 3))),
    "a place on a lane": ("LanePosition", lambda: written(brakes(), place=xosc().LanePosition(40, 0, "-1", "1"))),
    "a place beside another": (
        "RelativeWorldPosition",
        lambda: written(brakes(), place=xosc().RelativeWorldPosition("Ego", 20, 0, 0)),
    ),
    "an acceleration": (
        "AccelerationCondition",
        lambda: written(brakes(), by(xosc().AccelerationCondition(2, more()))),
    ),
    "standing still": ("StandStillCondition", lambda: written(brakes(), by(xosc().StandStillCondition(2)))),
    "a state of the story": (
        "StoryboardElementStateCondition",
        lambda: written(brakes(), xosc().ValueTrigger("state", 0, xosc().ConditionEdge.none, state())),
    ),
    "half a controller": ("ActivateControllerAction", lambda: written(switch(True, False), actor="Ego")),
    "a pedal that is overridden": ("Brake", lambda: written(also=overridden())),
    "a controller that is switched off": (
        "PrivateAction",
        lambda: written(xosc().ControllerAction(activateControllerAction=switch(False)), actor="Ego"),
    ),
    "a controller switched by a gap": ("PrivateAction", lambda: written(switch(True), by(distance()), actor="Ego")),
    "one condition or another": ("ConditionGroup", lambda: written(brakes(), either())),
}
"""By what it shows: the element that is refused, and the file."""


@cache
def all_files() -> tuple[bytes, ...]:
    """Return all files."""
    return (*(make() for make in UNDERSTOOD.values()), *(make() for _, make in NOT_UNDERSTOOD.values()))


def file_of(*inner: str, within: str = "Deterministic") -> bytes:
    """A file of parameter values, by hand."""
    values = f"<{within}>{''.join(inner)}</{within}>"
    head = '<FileHeader revMajor="1"/><ParameterValueDistribution><ScenarioFile filepath="a.xosc"/>'
    return f"<OpenSCENARIO>{head}{values}</ParameterValueDistribution></OpenSCENARIO>".encode()


def single(inner: str, name: str = "speed") -> str:
    tag = "DeterministicSingleParameterDistribution"
    return f'<{tag} parameterName="{name}">{inner}</{tag}>'


def span(low: float, high: float, step: float) -> str:
    limits = f'<Range lowerLimit="{low}" upperLimit="{high}"/>'
    return single(f'<DistributionRange stepWidth="{step}">{limits}</DistributionRange>')


WORDS: Final = ("", "nan", "inf", "-1e9", "1e300", "zwölf", "$speed", "$no", "${1+1}", "true", "0", "\x7f", "9" * 400)


def mutated(content: bytes, rng: random.Random) -> bytes:
    """Return a file after one thing that happens to files: an edit, a loss, a copy."""
    text = content.decode()
    how = rng.randrange(8)
    tags = [match.span() for match in re.finditer(r"<[^>]+>", text)]
    values = [match.span(1) for match in re.finditer(r'="([^"]*)"', text)]
    if how == 0:  # a value that is another
        start, end = rng.choice(values)
        return (text[:start] + rng.choice(WORDS) + text[end:]).encode()
    if how == 1:  # an element without its begin or end
        start, end = rng.choice(tags)
        return (text[:start] + text[end:]).encode()
    if how == 2:  # an element twice
        start, end = rng.choice([span for span in tags if text[span[1] - 2] == "/"])
        return (text[:end] + text[start:end] + text[end:]).encode()
    if how == 3:  # an element with another name
        start, end = rng.choice([span for span in tags if text[span[1] - 2] == "/"])
        return (text[:start] + re.sub(r"<\w+", "<Elsewhere", text[start:end]) + text[end:]).encode()
    if how == 4:  # an attribute that is gone
        start, end = rng.choice([match.span() for match in re.finditer(r' \w+="[^"]*"', text)])
        return (text[:start] + text[end:]).encode()
    if how == 5:  # a file that was cut off
        return content[: rng.randrange(len(content))]
    if how == 6:  # a byte that is another
        at = rng.randrange(len(content))
        return content[:at] + bytes([rng.randrange(256)]) + content[at + 1 :]
    start, end = rng.choice([span for span in tags if text[span[1] - 2] == "/"])  # an element that is gone
    return (text[:start] + text[end:]).encode()


NAMED: Final = re.compile(r"made\.xosc: (line \d+: (<[\w.:-]+>|not XML): |<[\w.:-]+>: )")  # as names are in XML
"""How a refusal begins: with the element and its line; of a file that is none or lacks a part, with what it is."""
