from pathlib import Path

import pytest

from simconsole.profiles.files import loader as profile_files
from simconsole.profiles.files.loader import names, profiles_folder
from simconsole.profiles.session import SessionProfile
from simconsole.profiles.vehicle import CarProfile
from simconsole.session.resolution import (
    headless,
    load_scenario,
    load_session,
    override,
    parted,
    resolve,
    with_named_values,
)
from simconsole.values.errors import ProfileError
from simconsole.world.kinds.worlds import open_world


def write(path: Path, text: str) -> str:
    path.write_text(text)
    return str(path)


@pytest.mark.parametrize("name", profile_files.names("sessions"))
def test_every_shipped_session_resolves_to_profiles_in_full(name: str) -> None:
    resolved = resolve(load_session(name))
    assert resolved.session.title
    assert (resolved.world is None) == (resolved.session.environment.world is None)


@pytest.mark.parametrize("name", profile_files.names("scenarios"))
def test_every_shipped_scenario_loads_with_its_file(name: str) -> None:
    scenario, path = load_scenario(name)
    assert path.stem == name
    assert scenario.checks


def test_a_session_has_the_papers_six_sections() -> None:
    sections = [field for field in SessionProfile.__struct_fields__ if field not in ("schema", "title")]
    assert sections == ["environment", "scenario", "features", "outputs", "devices", "mode"]


def test_a_car_on_a_road_map_starts_with_its_rear_beyond_the_beginning_of_its_road() -> None:
    for name in ("urban_signals", "urban"):
        session = override(load_session("demo"), environment={"world": name})
        resolved = resolve(session)
        start, car = resolved.session.scenario.start, resolved.vehicle
        assert resolved.world is not None
        assert start is not None
        assert isinstance(car, CarProfile)
        route = open_world(resolved.world).route
        rear_m = route.project(start.x_m, start.y_m).s_m - car.body.rear_overhang_m
        assert rear_m == pytest.approx(1.0 if name == "urban_signals" else -car.body.rear_overhang_m, abs=1e-3)


def test_override_replaces_single_keys_and_leaves_the_rest() -> None:
    demo = load_session("demo")
    changed = override(demo, mode={"pacing": "realtime"}, scenario={"duration_s": 3.5})
    assert changed.mode.pacing == "realtime"
    assert changed.mode.tick_hz == demo.mode.tick_hz
    assert changed.scenario.duration_s == 3.5
    assert changed.scenario.vehicle == demo.scenario.vehicle
    assert changed.devices == demo.devices
    assert demo.mode.pacing == "lockstep"


@pytest.mark.parametrize(
    ("section", "keys", "message"),
    [
        ("mode", {"pacing": "slow"}, 'mode.pacing: value "slow": '),
        ("scenario", {"duration_s": 0.0}, "scenario.duration_s: value 0.0: a number, above 0"),
        ("devices", {"driver": "trace:"}, 'devices.driver: value "trace:": '),
    ],
)
def test_override_refuses_what_a_profile_refuses(section: str, keys: dict[str, object], message: str) -> None:
    with pytest.raises(ProfileError, match=f"^command line: {message}"):
        override(load_session("demo"), **{section: keys})


def test_script_and_trace_of_a_session_lie_beside_it(tmp_path: Path) -> None:
    for driver, whole in (
        ("script:person.yaml", f"script:{tmp_path / 'person.yaml'}"),
        ("trace:deeper/trace.csv", f"trace:{tmp_path / 'deeper' / 'trace.csv'}"),
        ("virtual", "virtual"),
    ):
        path = write(tmp_path / "session.yaml", f"schema: 1\ndevices: {{driver: '{driver}'}}\n")
        assert load_session(path).devices.driver == whole


def test_a_bag_of_a_session_lies_beside_it(tmp_path: Path) -> None:
    for commands, whole in (
        ("bag:drive.mcap", f"bag:{tmp_path / 'drive.mcap'}"),
        ("bag:bags/drive.bag:/ego/cmd", f"bag:{tmp_path / 'bags' / 'drive.bag'}:/ego/cmd"),
    ):
        path = write(tmp_path / "session.yaml", f"schema: 1\nfeatures: {{commands: '{commands}'}}\n")
        assert load_session(path).features.commands == whole
    path = write(tmp_path / "session.yaml", "schema: 1\nfeatures: {commands: 'bag:../drive.mcap'}\n")
    with pytest.raises(ProfileError, match=r'features\.commands: value "bag:\.\./drive\.mcap": a file inside'):
        load_session(path)


def test_message_types_of_a_session_lie_beside_it(tmp_path: Path) -> None:
    path = write(tmp_path / "session.yaml", "schema: 1\noutputs: {bridge: {messages: types}}\n")
    bridge = load_session(path).outputs.bridge
    assert bridge is not None
    assert bridge.messages == str(tmp_path / "types")
    path = write(tmp_path / "session.yaml", "schema: 1\noutputs: {bridge: {messages: ../types}}\n")
    with pytest.raises(ProfileError, match=r'outputs\.bridge\.messages: value "\.\./types": a file inside'):
        load_session(path)


def test_a_link_does_not_lead_a_session_out_of_its_folder(tmp_path: Path) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "secret.yaml").write_text("points: []\n")
    (inside / "linked.yaml").symlink_to(tmp_path / "secret.yaml")
    path = write(inside / "session.yaml", "schema: 1\ndevices: {driver: 'script:linked.yaml'}\n")
    with pytest.raises(ProfileError, match=r'devices\.driver: value "script:linked\.yaml": a file inside '):
        load_session(path)


def test_a_profile_that_is_named_but_missing_is_one_line(tmp_path: Path) -> None:
    path = write(tmp_path / "session.yaml", "schema: 1\nscenario: {vehicle: spaceship}\n")
    with pytest.raises(ProfileError, match=f"'spaceship': one of {', '.join(names('vehicles'))}") as caught:
        resolve(load_session(path))
    assert "\n" not in str(caught.value)


def test_world_course_and_cockpit_may_lie_beside_the_session(tmp_path: Path) -> None:
    shipped = profiles_folder()
    for kind, name, mine in (("worlds", "urban", "town.yaml"), ("devices", "t500rs_th8rs", "seat.yaml")):
        (tmp_path / mine).write_text((shipped / kind / f"{name}.yaml").read_text())
    session = tmp_path / "session.yaml"
    session.write_text(
        "schema: 1\nenvironment: {world: town.yaml}\nfeatures: {autopilot: town.yaml}\ndevices: {cockpit: seat.yaml}\n"
    )
    loaded = load_session(str(session))
    assert loaded.features.autopilot == str((tmp_path / "town.yaml").resolve())
    named = override(loaded, environment={"world": "urban"}, devices={"cockpit": "t500rs_th8rs"})
    own, shipped_one = resolve(loaded), resolve(named)
    assert (own.world, own.cockpit) == (shipped_one.world, shipped_one.cockpit)
    for key in ("environment: {world", "features: {autopilot", "devices: {cockpit"):
        session.write_text(f"schema: 1\n{key}: ../town.yaml}}\n")
        with pytest.raises(ProfileError, match=r"value .*: a file inside"):
            load_session(str(session))


def test_a_vehicles_own_file_lies_beside_the_session_or_the_scenario_that_names_it(tmp_path: Path) -> None:
    mine = (profiles_folder() / "vehicles" / "hatchback.yaml").read_text().replace("mass_kg: 1300 ", "mass_kg: 1234 ")
    (tmp_path / "mine.yaml").write_text(mine)
    session = tmp_path / "session.yaml"
    session.write_text("schema: 1\nscenario: {vehicle: mine.yaml}\n")
    vehicle = resolve(load_session(str(session))).vehicle
    assert isinstance(vehicle, CarProfile)
    assert vehicle.body.mass_kg == 1234.0
    scenario = tmp_path / "scenario.yaml"
    text = (profiles_folder() / "scenarios" / "launch_and_stop.yaml").read_text()
    scenario.write_text(text.replace("vehicle: hatchback", "vehicle: mine.yaml"))
    assert resolve(load_scenario(str(scenario))[0].session).vehicle == vehicle
    for outside in ("../mine.yaml", "/etc/mine.yaml"):
        session.write_text(f"schema: 1\nscenario: {{vehicle: {outside}}}\n")
        with pytest.raises(ProfileError, match=r"scenario.vehicle: value .*: a file inside"):
            load_session(str(session))
    session.write_text("schema: 1\nscenario: {vehicle: ../mine}\n")
    with pytest.raises(ProfileError, match=r"scenario.vehicle"):
        load_session(str(session))


def test_keys_belong_to_the_session_or_to_what_it_names() -> None:
    values = {"environment.friction": 0.5, "body.mass_kg": 1600, "cockpit.title": "mine", "mode.tick_hz": 50}
    of_session, of_named = parted(values)
    assert list(of_session) == ["environment.friction", "mode.tick_hz"]
    assert list(of_named) == ["body.mass_kg", "cockpit.title"]


def test_no_key_of_a_vehicle_is_taken_for_one_of_a_session() -> None:
    """Without a prefix a key is the vehicle's unless a section of sessions has its name."""
    sections = {*SessionProfile.__struct_fields__, "vehicle", "cockpit", "world"}
    assert not sections & {*CarProfile.__struct_fields__}


def test_named_values_change_each_profile_that_they_name() -> None:
    resolved = resolve(load_session("bridge"))
    values = {
        "body.mass_kg": 1600,
        "vehicle.body.height_m": 1.6,
        "cockpit.title": "mine",
        "world.speed_limit_kmh": 30.0,
    }
    changed = with_named_values(resolved, values, "test")
    assert isinstance(changed.vehicle, CarProfile)
    assert (changed.vehicle.body.mass_kg, changed.vehicle.body.height_m) == (1600.0, 1.6)
    assert (changed.cockpit.title, getattr(changed.world, "speed_limit_kmh", None)) == ("mine", 30.0)
    assert changed.session == resolved.session


def test_headless_is_without_window_and_clock_but_stays_in_lockstep() -> None:
    seated, ball = headless(load_session("seated")), headless(load_session("roll_a_ball"))
    assert (seated.outputs.hud, seated.mode.pacing) == (None, "free")
    assert ball.mode.pacing == "lockstep"


def test_the_displays_language_is_the_profiles_or_the_command_lines(tmp_path: Path) -> None:
    seated = load_session("seated")
    assert resolve(seated).language.title == "English"
    assert resolve(seated, language="german").language.words["YOU"] == "SIE"
    (tmp_path / "own.yaml").write_text('schema: 1\ntitle: Own\nwords: {"YOU": "PERSON"}\n')
    session = tmp_path / "session.yaml"
    session.write_text("schema: 1\noutputs: {hud: {language: own.yaml}}\n")
    assert resolve(load_session(str(session))).language.words == {"YOU": "PERSON"}
    (tmp_path / "own.yaml").write_text('schema: 1\ntitle: Own\nwords: {"YUO": "PERSON"}\n')
    with pytest.raises(ProfileError, match=r'own\.yaml: words: value "YUO": "YOU"'):
        resolve(load_session(str(session)))
    with pytest.raises(ProfileError, match="klingon"):
        resolve(seated, language="klingon")
