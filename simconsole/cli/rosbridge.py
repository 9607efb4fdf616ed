"""`simconsole bridge`: the rosbridge server alone, how any such server behaves, a certificate for ours."""

import secrets
from argparse import Namespace
from pathlib import Path

from simconsole.cli.outcome import Outcome, table
from simconsole.cli.remote import own_token
from simconsole.processes.lifetimes import INTERRUPTED
from simconsole.processes.shared_memory import temporary_folder
from simconsole.values.errors import ProfileError
from simconsole.values.labels import notice_label
from simconsole.values.state_vector import Snapshot


def serve(options: Namespace) -> Outcome:
    """Serve rosbridge on a standing car that nobody sits in, in real time, until interrupted; nothing is kept."""
    from simconsole.bridge.ros2.node import check as check_ros2
    from simconsole.bridge.transport.credentials import load_access, load_tls
    from simconsole.bridge.transport.message_files import load_registry
    from simconsole.bridge.transport.transport_registry import load_transport
    from simconsole.session.lifecycle import drive
    from simconsole.session.resolution import load_session, override, resolve

    certificate = options.certificate
    section = {
        "host": options.host,
        "port": options.port,
        "tokens": options.tokens,
        "certificate": certificate,
        "certificate_key": None if certificate is None else str(Path(certificate).with_suffix(".key")),
        "trust_network": options.trust_network,
        "transport": options.transport,
        "ros2": {} if options.ros2 else None,
        "messages": options.messages,
        "allowed_origins": options.origin,
        "limits": _limits(options.limit),
    }
    session = override(load_session("bridge"), outputs={"bridge": section})
    if options.duration_s is not None:
        session = override(session, scenario={"duration_s": options.duration_s})
    if session.outputs.bridge is not None:
        # Checked here and not only in the server's own process, so that a refusal is one line, at once.
        load_access(session.outputs.bridge)
        load_tls(session.outputs.bridge)
        check_ros2(session.outputs.bridge)
        load_registry(session.outputs.bridge)
        load_transport(session.outputs.bridge)
    with temporary_folder() as folder:
        result = drive(
            resolve(session),
            folder,
            watch=_NoticePrinter(),
            on_bridge=lambda url: print(f"rosbridge at {url}", flush=True),
        )
    code = INTERRUPTED if result.interrupted else 0
    return Outcome(code, result.summary, f"served {result.ticks} ticks, lateness {result.summary['lateness']}")


class _NoticePrinter:
    """Prints what a controller does not see by itself: that its commands wait for somebody to ask for autonomy."""

    def __init__(self) -> None:
        self._told = 0.0

    def __call__(self, snapshot: Snapshot) -> bool:
        """Print a new notice, each once in a row; never end the drive."""
        notice = snapshot.notice
        if notice and notice != self._told:
            print(notice_label(notice), flush=True)
            self._told = notice
        return False


def _limits(words: list[str]) -> dict[str, float]:
    """Return the limits given as NAME=NUMBER; whether there is such a limit, and its bounds, the profile says.

    Raises:
        ProfileError: a word is not of that form.
    """
    limits: dict[str, float] = {}
    for word in words:
        name, _, number = word.partition("=")
        try:
            limits[name] = int(number) if number.isdecimal() else float(number)
        except ValueError:
            raise ProfileError(f"command line: --limit: {word!r} is not NAME=NUMBER") from None
    return limits


def check(options: Namespace) -> Outcome:
    """Test the server at `options.url` where rosbridge servers differ; the code is 1 if it deviates anywhere."""
    from simconsole.bridge.tools import conformance

    rows = conformance.check(options.url, own_token())
    passed = sum(row.passed for row in rows)
    lines = [
        ("pass" if row.passed else "DEVIATION", f"{row.name}: {row.found}" if row.found else row.name) for row in rows
    ]
    results = {"url": options.url, "passed": passed, "rows": [row._asdict() for row in rows]}
    return Outcome(0 if passed == len(rows) else 1, results, f"{table(lines)}\n{passed} of {len(rows)} pass")


def bench(options: Namespace) -> Outcome:
    """Measure the throughput of our server, a bare broker and, if given, the server at `options.url`."""
    from simconsole.bridge.tools import bench, bench_load, bench_peers

    found = bench.bench(url=options.url, seconds=options.duration_s or 1.0)
    rates_hz = {case: figures.rate_hz for case, figures in found.items()}
    rows, lines = [], []
    for case, figures in sorted(found.items(), key=lambda pair: (pair[0].message, pair[0].subscribers)):
        # Each is compared with the bare broker of its own library, a foreign server with that of websockets.
        share = figures.rate_hz / rates_hz[case._replace(server="bare", library=case.library or "websockets")]
        url_hz = rates_hz.get(case._replace(server="url", library=""))
        times = {} if url_hz is None or case.server == "url" else {"times_url": figures.rate_hz / url_hz}
        rows.append({**case._asdict(), **figures._asdict(), "share_of_bare": share, **times})
        beside = "".join(f", {value:.1f} times url" for value in times.values())
        cpu = "" if figures.cpu_us is None else f", {figures.cpu_us:.1f} us of processor each"
        lines.append(
            (
                f"{case.message} to {case.subscribers}: {case.server} {case.library}".rstrip(),
                f"{figures.rate_hz:7.0f}/s each ({share:.2f} of bare{beside}, {figures.under_way:.0f} under way{cpu}), "
                f"at 100 Hz p50 {figures.p50_ms:.2f} ms, p99 {figures.p99_ms:.2f} ms",
            )
        )
    load = bench_load.load()
    lines += [
        (
            "beside a stalled subscriber",
            f"{load.lost} of {bench_load.MESSAGES} lost by another, {load.growth_mb:.1f} MB more memory",
        ),
        (
            f"flood of {load.sent_hz:.0f} commands a second",
            f"age of the applied one p50 {load.age_p50_ms:.1f} ms, p99 {load.age_p99_ms:.1f} ms, "
            f"max {load.age_max_ms:.1f} ms",
        ),
    ]
    return Outcome(0, {"clients": bench_peers.library(), "rows": rows, "load": load._asdict()}, table(lines))


def cert(options: Namespace) -> Outcome:
    """Write a self-signed certificate for `--host`, its key and a control token, readable by their owner alone."""
    from simconsole.cli.certificate import make, write_private

    folder = Path(options.out)
    folder.mkdir(parents=True, exist_ok=True)
    certificate, key, tokens = folder / "bridge.pem", folder / "bridge.key", folder / "bridge.tokens"
    written = make(options.host)
    certificate.write_bytes(written.certificate)
    write_private(key, written.key)
    write_private(tokens, f"control {secrets.token_urlsafe(24)}\n".encode())
    paths = {"certificate": str(certificate), "key": str(key), "tokens": str(tokens)}
    command = f"simconsole bridge serve --host {options.host} --tokens {tokens} --certificate {certificate}"
    return Outcome(0, {**paths, "until": written.until}, f"good until {written.until}; serve with\n{command}")
