import json
import re

import pytest

from simconsole.bridge.messages import Registry, standard_registry
from simconsole.recording.exports.drive_topics import DriveTopics
from simconsole.recording.exports.foxglove import LAYOUT, foxglove_layout, topic_paths
from tests.recording.made import SESSION, MadeRecording


def fits(registry: Registry, type_name: str, path: str) -> bool:
    """Whether a type has a field `a.b`."""
    if not path:
        return True
    name, _, rest = path.partition(".")
    fields = {field.name: field.type for field in registry.definition(type_name).fields}
    kind = fields.get(re.sub(r"\[.*", "", name))
    return kind is not None and (not rest or fits(registry, kind.base, rest))


def test_every_path_of_the_layout_is_a_topic_of_an_export_and_a_field_of_it(recording: MadeRecording) -> None:
    types = {message.topic: message.type for message in DriveTopics(SESSION).messages(recording)}
    paths = topic_paths(json.loads(LAYOUT.read_text()))
    assert len(paths) > 10
    for path in paths:
        topic, _, field = path.partition(".")
        assert topic in types, path
        assert fits(standard_registry(), types[topic], field), path


def test_every_panel_of_the_layout_is_configured() -> None:
    layout = json.loads(LAYOUT.read_text())

    def leaves(part: object) -> list[str]:
        return leaves(part["first"]) + leaves(part["second"]) if isinstance(part, dict) else [str(part)]

    assert sorted(leaves(layout["layout"])) == sorted(layout["configById"])


def test_a_drive_s_own_names_stand_in_it() -> None:
    layout = json.loads(foxglove_layout({"/odom": "/ego/pose", "/console/arbitration": "/ego/console/arbitration"}))
    paths = topic_paths(layout)
    assert "/ego/pose" in paths
    assert "/ego/console/arbitration.mode_words" in paths
    assert not [path for path in paths if path.startswith(("/odom", "/console/arbitration"))]


@pytest.mark.parametrize("value", [{"a": ["/x.y", 3]}, {"/x.y": {"b": None}}])
def test_paths_are_found_in_keys_and_values(value: object) -> None:
    assert topic_paths(value) == ["/x.y"]
