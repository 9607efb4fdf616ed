"""Services and actions everybody has: std_srvs, and the examples stock clients are tried with."""

from typing import Final

SERVICES: Final[dict[str, str]] = {
    "std_srvs/Empty": "---\n",
    "std_srvs/Trigger": "---\nbool success\nstring message\n",
    "std_srvs/SetBool": "bool data\n---\nbool success\nstring message\n",
    "simconsole_msgs/Operate": (
        "# What /console/request takes: autonomous, manual, shared, takeover, estop, reset, mark, pause, start,\n"
        "# restart, fault. Note, participant and trial may be empty.\n"
        "string act\nstring note\nstring participant\nstring trial\n---\n"
        "bool accepted\n# The newest tick before the act.\nuint64 tick\n"
    ),
    "example_interfaces/AddTwoInts": "int64 a\nint64 b\n---\nint64 sum\n",
}

ACTIONS: Final[dict[str, str]] = {
    "example_interfaces/Fibonacci": "int32 order\n---\nint32[] sequence\n---\nint32[] sequence\n",
}
