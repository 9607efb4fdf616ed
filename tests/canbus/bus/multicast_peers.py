"""The console's bus and a plain python-can program, once each way: prints the id that each heard of the other, or None.

The group is that of docs/can.md.
"""

import can
from can.interfaces.udp_multicast import utils

from simconsole.canbus.bus.multicast import LoopbackBus
from tests.patience import PATIENCE_S

GROUP, PORT = "239.74.163.2", 43113


def heard(bus: "LoopbackBus | can.BusABC", wanted: int) -> str:
    """What a bus hears of a message with this id: others, as its own, are passed over."""
    while (message := bus.recv(PATIENCE_S)) is not None:
        if message.arbitration_id == wanted:
            return hex(wanted)
    return "None"


def main() -> None:
    """Let both speak."""
    console = LoopbackBus(
        GROUP, PORT, utils.pack_message, lambda data, now_s: utils.unpack_message(data, {"timestamp": now_s}, True)
    )
    with can.Bus(interface="udp_multicast", channel=GROUP, port=PORT) as plain:
        plain.send(can.Message(arbitration_id=0x111, data=[1], is_extended_id=False))
        console.send(can.Message(arbitration_id=0x222, data=[2], is_extended_id=False))
        print(heard(console, 0x111), heard(plain, 0x222))
    console.shutdown()


if __name__ == "__main__":
    main()
