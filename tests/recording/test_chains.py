import io

import numpy as np

from simconsole.recording.chains import Chains
from simconsole.recording.framing import Record
from simconsole.recording.scan import Scan


def followed(records: list[Record], content: bytes) -> Chains:
    chains = Chains(Scan(io.BytesIO(content).read, "drive.log").header)
    for record in records:
        chains.follow(record)
    return chains


def test_whole_chains_hold_to_the_end(log_with_acts: bytes) -> None:
    records = list(Scan(io.BytesIO(log_with_acts).read, "drive.log"))
    chains = followed(records, log_with_acts)
    assert (chains.digest, chains.broken, chains.problems()) == (records[-1].digest, {}, [])


def test_each_stream_is_named_where_its_chain_first_fails(log_with_acts: bytes) -> None:
    records = list(Scan(io.BytesIO(log_with_acts).read, "drive.log"))
    vector = records[6].vector.copy()
    vector[0] = np.nextafter(vector[0], 1.0)
    records[6] = records[6]._replace(vector=vector)
    (message,) = records[19].messages
    records[19] = records[19]._replace(messages=(message._replace(content=b"another"),))
    chains = followed(records, log_with_acts)
    assert chains.broken == {"state": 7, "acts": 20}
    assert chains.problems() == [
        "stream state: the chained hash does not hold at tick 7",
        "stream acts: the chained hash does not hold at tick 20",
    ]


def test_a_message_that_was_taken_out_shows_in_the_next_one(log_with_acts: bytes) -> None:
    records = list(Scan(io.BytesIO(log_with_acts).read, "drive.log"))
    records[3] = records[3]._replace(messages=())
    assert followed(records, log_with_acts).broken == {"acts": 20}
