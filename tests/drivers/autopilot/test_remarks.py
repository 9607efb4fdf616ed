"""The console's remarks are told once each, and a flood of them is not."""

from simconsole.bridge.protocol.operations import Status
from simconsole.drivers.autopilot.remarks import Remarks


def test_what_is_new_is_told_in_order() -> None:
    said: list[str] = []
    remarks = Remarks(said.append)
    first, second, third = (Status(level="error", msg=text) for text in ("a", "b", "c"))
    remarks.tell([])
    remarks.tell([first])
    remarks.tell([first])
    remarks.tell([first, second, third])
    assert said == [f"the console says ({n}): error: {text}" for n, text in ((1, "a"), (2, "b"), (3, "c"))]


def test_of_many_the_first_ten_and_each_thousandth() -> None:
    said: list[str] = []
    remarks = Remarks(said.append)
    for number in range(2500):
        remarks.tell([Status(level="warning", msg=str(number))])
    assert [line.rpartition(" ")[2] for line in said] == [*map(str, range(10)), "999", "1999"]
