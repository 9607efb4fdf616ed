"""The bridge section of a session profile: where rosbridge listens, what its topics are called, what it refuses."""

from math import radians, tan
from typing import Annotated, Literal

from msgspec import Meta, Struct, field

from simconsole.profiles.link import LinkProfile
from simconsole.profiles.validation import worded

TopicName = Annotated[
    str,
    worded(
        r"^/[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*$",
        "/NAME/NAME, up to 256 characters: each name of letters, digits and _, a letter first",
        max_length=256,
    ),
]
Namespace = Annotated[
    str,
    worded(
        r"^(/[A-Za-z][A-Za-z0-9_]*)*$",
        "empty, or /NAME/NAME, up to 128 characters: each name of letters, digits and _, a letter first",
        max_length=128,
    ),
]
_ORIGIN = worded(
    r"^(https?://[^/\s]+|null|file://|app://[^/\s]*)$", "http://HOST, https://HOST, app://NAME, file:// or null"
)
Origin = Annotated[str, _ORIGIN]
Rate = Annotated[float, Meta(ge=0.0, le=1000.0)]


Path = Annotated[str, Meta(min_length=1, max_length=4096)]


class CommandLimits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Limits of a command; one beyond any of them is refused whole, because it is an error of the sender."""

    road_wheel_rad: Annotated[float, Meta(gt=0.0, le=1.2)] = 1.2
    """Largest road-wheel angle, to either side, that a command may ask for."""
    road_wheel_radps: Annotated[float, Meta(gt=0.0, le=100.0)] = 20.0
    """Fastest turning of the road wheels that a command may ask for."""
    speed_mps: Annotated[float, Meta(gt=0.0, le=150.0)] = 80.0
    """Highest speed, forwards or backwards, that a command may ask for."""
    accel_mps2: Annotated[float, Meta(gt=0.0, le=50.0)] = 12.0
    """Strongest acceleration or braking that a command may ask for."""
    yaw_rate_radps: Annotated[float, Meta(gt=0.0, le=20.0)] = 10.0
    """Fastest turning of the vehicle about its upright axis that a command may ask for."""
    position_m: Annotated[float, Meta(gt=0.0, le=1e6)] = 1e5
    """Farthest a commanded position may be from the origin of the map, along x and along y."""


class BridgeLimits(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Resources that one client, or all together, may use."""

    clients: Annotated[int, Meta(ge=1, le=1024)] = 64
    """Most connections at a time; where there are tokens, of clients that have shown one."""
    tokenless_clients: Annotated[int, Meta(ge=1, le=1024)] = 16
    """Where there are tokens: most connections that have shown none. They take no place of `clients`."""
    tokenless_s: Annotated[float, Meta(gt=0.0, le=3600.0)] = 10.0
    """How long a connection that may do nothing is kept for a token to come."""
    message_bytes: Annotated[int, Meta(ge=1024, le=67_108_864)] = 10_000_000
    """Longest message of a client whose role is publish or control."""
    viewer_message_bytes: Annotated[int, Meta(ge=1024, le=16_777_216)] = 262_144
    """Longest message of any other client, where `message_bytes` is not less."""
    message_fragments: Annotated[int, Meta(ge=1, le=65_536)] = 256
    """Most pieces that one message of a client may be sent in (rosbridge's `fragment`)."""
    subscriptions: Annotated[int, Meta(ge=1, le=4096)] = 256
    """Most topics that one client may subscribe to, and most subscriptions of it to one topic."""
    topics: Annotated[int, Meta(ge=16, le=4096)] = 256
    """Most topics that exist at a time, those that clients advertise included."""
    calls: Annotated[int, Meta(ge=1, le=4096)] = 64
    """Most calls of services and goals of actions that one client may have open at a time."""
    call_s: Annotated[float, Meta(gt=0.0, le=3600.0)] = 30.0
    """How long a call of a service or a goal of an action may stay without an answer before it is given up."""
    commands_hz: Annotated[float, Meta(ge=1.0, le=100_000.0)] = 500.0
    """Most commands of one client, averaged over a second; those beyond this rate are dropped, not queued."""
    answered_bytes_per_s: Annotated[float, Meta(ge=65_536.0, le=1e9)] = 4e6
    """Answers to one client; what it sends after more is handled later. Each piece of an answer counts 64 bytes
    more."""
    queue_length: Annotated[int, Meta(ge=1, le=100_000)] = 1000
    """Most messages of one topic that wait for one client; older ones are dropped first."""
    queued_bytes: Annotated[int, Meta(ge=65_536, le=67_108_864)] = 1_048_576
    """What may wait for one client; the newest message of each topic is kept whatever its length."""
    all_queued_bytes: Annotated[int, Meta(ge=1_048_576, le=1_073_741_824)] = 67_108_864
    """What may wait for all clients together."""


class Ros2Profile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The console as a node of a live ROS 2 graph. A graph has no tokens: these keys say what it may do."""

    node: Annotated[
        str, worded(r"^[A-Za-z][A-Za-z0-9_]*$", "letters, digits and _, up to 64, a letter first", max_length=64)
    ] = "simconsole"
    """Name of the console's node in the ROS 2 graph."""
    domain_id: Annotated[int, Meta(ge=0, le=232)] | None = None
    """Number of the ROS 2 domain to join; without it the environment variable ROS_DOMAIN_ID says it."""
    role: Literal["view", "publish", "control"] | None = None
    """What the nodes of the graph may do; left out, what a rosbridge client that shows no token may, at least view."""
    discovery: Literal["localhost", "subnet"] = "localhost"
    """Which nodes are found: of this machine, or with `subnet` of others too, which needs `trust_network`, for a graph
    shows no tokens."""


class UpstreamProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Another rosbridge server that the console joins as a client, under the names its own topics have."""

    url: Annotated[
        str, worded(r"^wss?://[^/\s]+", "ws://HOST:PORT or wss://HOST:PORT, up to 1024 characters", max_length=1024)
    ]
    """Address of the other rosbridge server, `ws://HOST:PORT` or `wss://HOST:PORT`."""
    token: Path | None = None
    """File whose content is the token that the other server asks for; without it none is shown."""
    certificate: Path | None = None
    """PEM file that a wss:// server is checked against, in place of the system's authorities."""
    dialect: Literal["ros2", "ros1"] = "ros2"
    """Which ROS the other server has: how times and headers are spelled for it."""


class CameraProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A camera on the vehicle whose pictures the bridge publishes. Place and angles are those of base_link."""

    rate_hz: Annotated[float, Meta(gt=0.0, le=60.0)] = 10.0
    """How many pictures are published in a second."""
    width_px: Annotated[int, Meta(ge=64, le=4096)] = 640
    """Width of the picture."""
    height_px: Annotated[int, Meta(ge=48, le=4096)] = 480
    """Height of the picture."""
    horizontal_fov_deg: Annotated[float, Meta(ge=10.0, le=150.0)] = 70.0
    """Angle that the picture shows from its left edge to its right edge."""
    x_m: Annotated[float, Meta(ge=-20.0, le=20.0)] = 1.8
    """How far ahead of base_link the camera is; the default place is behind the windscreen of a car."""
    y_m: Annotated[float, Meta(ge=-20.0, le=20.0)] = 0.0
    """How far to the left of base_link the camera is."""
    z_m: Annotated[float, Meta(ge=0.05, le=50.0)] = 1.3
    """Height of the camera above base_link, which lies on the ground."""
    yaw_deg: Annotated[float, Meta(ge=-180.0, le=180.0)] = 0.0
    """Where the camera looks, counted from straight ahead; left is positive."""
    pitch_deg: Annotated[float, Meta(ge=-90.0, le=90.0)] = 0.0
    """How far the camera looks down; a negative angle looks up."""
    night: bool = False
    """Draw the scene by night, with headlights."""

    @property
    def focal_px(self) -> float:
        """Focal length in pixels: that of a pinhole, without distortion."""
        return 0.5 * self.width_px / tan(radians(0.5 * self.horizontal_fov_deg))


class BridgeProfile(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One rosbridge server.

    `namespace` is put before every topic but /clock, /tf and /tf_static; `rename` maps a topic's standard name to
    its name here and wins over the namespace. `rates_hz` changes how often a standard topic is published, 0 never.
    """

    host: Annotated[str, Meta(min_length=1, max_length=253)] = "127.0.0.1"
    """Address or host name on which the server listens; the default is reached from this machine only."""
    port: Annotated[int, Meta(ge=0, le=65_535)] = 9090
    """TCP port on which the server listens; 0 lets the system choose."""
    transport: Literal["websockets", "picows"] = "websockets"
    """The library that carries clients' connections; picows (extra `picows`) takes less time for many. Without
    effect in lockstep, where the core serves its own sockets."""
    namespace: Namespace = ""
    """Put before the name of every topic but /clock, /tf and /tf_static, as `/car1`; empty for none."""
    rename: dict[TopicName, TopicName] = field(default_factory=dict)
    """New names of topics by their standard names; a name given here wins over `namespace`."""
    rates_hz: dict[TopicName, Rate] = field(default_factory=dict)
    """How often a standard topic is published in a second, by its standard name; 0 never publishes it. A topic that is
    not named keeps its own rate."""
    odometry_frame: Annotated[str, Meta(min_length=1, max_length=64)] = "odom"
    """Name of the frame that odometry and /tf are given in."""
    allowed_origins: tuple[Origin, ...] = ()
    """Web pages that may connect beside those of this machine; programs send no origin and always may. `null` and
    `file://` are pages opened from a file, `app://...` those of a desktop program."""
    allowed_hosts: tuple[
        Annotated[str, worded(r"^[A-Za-z0-9.:\[\]-]+$", "a host by name or number, without its port")], ...
    ] = ()
    """Host names, without port, by which this server may be addressed beside `host` and localhost."""
    dialect: Literal["ros2", "ros1"] = "ros2"
    """How times and headers are spelled for clients whose URL's path is neither /ros1 nor /ros2."""
    tokens: Path | None = None
    """File of lines `ROLE TOKEN`; left out, whoever can connect may do everything."""
    anonymous: Literal["none", "view", "publish"] = "none"
    """What a client may do that shows no token, where there are tokens."""
    certificate: Path | None = None
    """PEM file with the server's certificate; with it and `certificate_key` the server speaks TLS only (wss://)."""
    certificate_key: Path | None = None
    """PEM file with the private key of `certificate`; both are given, or neither."""
    trust_network: bool = False
    """Listen on an address that others can reach although there is neither token nor TLS."""
    messages: Path | None = None
    """Folder of own message types, PACKAGE/msg/NAME.msg, .srv and .action, inside that of the session's profile."""
    record: tuple[Annotated[str, Meta(min_length=1, max_length=256)], ...] = ()
    """Names of topics that are recorded into topics.mcap in the bundle; * and ? stand for any characters, as in file
    names."""
    upstream: UpstreamProfile | None = None
    """Another rosbridge server to connect to as well: every output is published there, every command asked for."""
    ros2: Ros2Profile | None = None
    """Join a live ROS 2 graph as well; needs rclpy (extra `ros2`)."""
    sender_clock: Literal["own", "console"] = "own"
    """Whose clock senders stamp with; `console` is /clock, so that stamps from the future and stale ones are refused
    too."""
    max_stamp_age_ms: Annotated[float, Meta(gt=0.0, le=10_000.0)] = 200.0
    """A command whose stamp is older than this is refused as stale."""
    lease_ms: Annotated[float, Meta(ge=50.0, le=10_000.0)] = 500.0
    """A client that commands keeps the right to do so for this long after its last command; then another may take
    it."""
    ping_interval_s: Annotated[float, Meta(gt=0.0, le=60.0)] = 1.0
    """A client that sends nothing for this long is sent a ping."""
    dead_after_s: Annotated[float, Meta(gt=0.0, le=600.0)] = 3.0
    """A client is taken for gone when for this long nothing came from it and its machine acknowledged nothing, though
    the console listened."""
    stall_close_s: Annotated[float, Meta(gt=0.0, le=600.0)] = 10.0
    """A client that is connected but reads nothing for this long is disconnected."""
    external_view: bool = False
    """Publish what a renderer of another program needs to be the driver's eyes, the car's true pose included."""
    camera: CameraProfile | None = None
    """A camera on the vehicle whose pictures are published, where `mode.pacing` is realtime; left out, there is
    none."""
    link: LinkProfile = LinkProfile()
    """Errors, delays and losses on purpose, between the car and whoever commands it here."""
    limits: BridgeLimits = BridgeLimits()
    """How much of this machine clients may use; without it the defaults."""
    commands: CommandLimits = CommandLimits()
    """Bounds beyond which a command is refused as an error of its sender; without it the defaults."""
