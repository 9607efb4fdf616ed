import io

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from simconsole.bridge.messages import standard_registry
from simconsole.bridge.messages.cdr import serialize
from simconsole.bridge.transport.topic_file import TopicFile

TEXT = "std_msgs/msg/String"


def test_messages_are_read_by_a_library_that_knows_nothing_of_us() -> None:
    registry, content = standard_registry(), io.BytesIO()
    file = TopicFile(content, registry)
    file.add("/said", TEXT)
    file.add("/said", TEXT)
    file.add("/kept", TEXT, latched=True)
    for number, word in enumerate(("a", "b")):
        file.write("/said", number, serialize(registry, TEXT, registry.struct(TEXT)(word)))
    file.finish()
    content.seek(0)
    reader = make_reader(content, decoder_factories=[DecoderFactory()])
    summary = reader.get_summary()
    assert summary is not None
    assert len(summary.schemas) == 1
    quality = {channel.topic: channel.metadata for channel in summary.channels.values()}
    assert quality["/said"] == {}
    assert "durability: 1" in quality["/kept"]["offered_qos_profiles"]
    found = [
        (message.log_time, message.publish_time, message.sequence, said.data)
        for _, _, message, said in reader.iter_decoded_messages()
    ]
    assert found == [(0, 0, 1, "a"), (1, 1, 2, "b")]
