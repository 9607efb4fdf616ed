"""The CAN section of a session profile: which bus, how the command is watched, what is logged."""

from typing import Annotated, Literal

from msgspec import Meta, Struct

from simconsole.profiles.validation import worded

Interface = Literal[
    "virtual", "udp_multicast", "socketcan", "pcan", "vector", "kvaser", "ixxat", "slcan", "gs_usb", "usb2can"
]
"""Back ends of python-can by their names there; vendor ones need the vendor's driver."""


class CanProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One CAN bus with the console on it.

    udp_multicast is kept on this machine (loopback interface, hop limit 0): CAN frames carry no sender and no token,
    so they must not be accepted from a network. A real bus is reached through its own interface.
    """

    interface: Interface = "udp_multicast"
    """Back end of python-can that the bus is reached through; those of vendors need the vendor's driver."""
    channel: Annotated[
        str,
        worded(
            r"^[A-Za-z0-9][A-Za-z0-9_.:/-]{0,127}$", "letters, digits and _.:/-, up to 128, a letter or digit first"
        ),
    ] = "239.74.163.2"
    """Name of the channel as the back end has it: a multicast group (IPv4), can0, PCAN_USBBUS1, 0."""
    port: Annotated[int, Meta(ge=1024, le=65_535)] = 43_113
    """UDP port of udp_multicast; other back ends have none."""
    bitrate_bps: Annotated[int, Meta(ge=10_000, le=1_000_000)] | None = None
    """Bit rate that is asked of back ends that set it themselves; that of socketcan is set by `ip link`."""
    log: tuple[Literal["blf", "candump", "asc"], ...] = ("blf",)
    """Which logs of the bus lie in the bundle: can.blf, can.log, can.asc."""
    command_timeout_ms: Annotated[float, Meta(ge=20.0, le=10_000.0)] = 200.0
    """After this long without a good command the reception starts anew (commands are stale after 200 ms)."""
    counter_step_max: Annotated[int, Meta(ge=1, le=7)] = 2
    """Largest step of a message's counter that is still in sequence: 2 lets one frame be lost."""
    invalid_max: Annotated[int, Meta(ge=1, le=100)] = 5
    """After this many bad frames in a row the counter is taken anew from the last (opendbc: 5 wrong counters)."""
    retry_first_s: Annotated[float, Meta(ge=1.0, le=30.0)] = 1.0
    """A bus that went off is opened again after this time, then after twice as long each time, up to `retry_last_s`."""
    retry_last_s: Annotated[float, Meta(ge=1.0, le=30.0)] = 30.0
    """Longest wait from one try to open a lost bus to the next."""
