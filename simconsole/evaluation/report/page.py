"""The report: one HTML file that needs nothing else (shell: it writes the file)."""

from collections.abc import Mapping, Sequence
from html import escape
from pathlib import Path
from typing import Any, Final

from simconsole.evaluation.metrics.drive_metrics import metrics, mode_changes
from simconsole.evaluation.metrics.rule_metrics import RULES
from simconsole.evaluation.metrics.table import Drive
from simconsole.evaluation.metrics.track import track
from simconsole.evaluation.report.figures import map_svg, traces_svg
from simconsole.values.errors import RecordingError
from simconsole.values.host.files import write_atomically
from simconsole.world.route import Route

STYLE: Final = """
:root{color-scheme:light}
body{font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:#202124;background:#fff;
max-width:960px;margin:2rem auto;padding:0 1rem}
h1{font-size:1.5rem;margin:0 0 .2rem}h2{font-size:1.1rem;margin:2rem 0 .5rem}
p.note{color:#5f6368;margin:.2rem 0 1rem}
table{border-collapse:collapse;width:100%;font-variant-numeric:tabular-nums}
th,td{text-align:left;padding:.28rem .8rem .28rem 0;border-bottom:1px solid #e8eaed;vertical-align:top}
th{font-weight:600;color:#5f6368}td.n,th.n{text-align:right}
ul.tiles{display:flex;flex-wrap:wrap;gap:.8rem;padding:0;margin:1rem 0;list-style:none}
ul.tiles li{flex:1 1 8rem;border:1px solid #e8eaed;border-radius:6px;padding:.6rem .8rem}
ul.tiles b{display:block;font-size:1.25rem;font-variant-numeric:tabular-nums}
ul.tiles span{color:#5f6368;font-size:.85rem}
figure{margin:1rem 0}svg{width:100%;height:auto}
"""

_TAKEOVER: Final = (
    ("first_steer_s", "first steering, s"),
    ("first_brake_s", "first brake, s"),
    ("first_throttle_s", "first accelerator, s"),
    ("authority_s", "authority, s"),
    ("peak_deviation_m", "largest deviation, m"),
    ("peak_lateral_jerk_mps3", "largest lateral jerk, m/s3"),
)
_ROAD: Final = (
    ("lights_passed", "Lights passed"),
    ("lights_stood_at", "Stood at, of these"),
    ("let_pass", "Somebody had to be let pass"),
)
_ADVICE: Final = (
    ("lights", "Lights, in all", "{:.0f}"),
    ("stops", "Stood", "{:.0%}"),
    ("waiting_s", "Waiting", "{:.1f} s"),
    ("time_loss_s", "Time lost against the limit", "{:.1f} s"),
    ("energy_jpkg", "Energy to gain speed", "{:.0f} J/kg"),
)
METRICS: Final[tuple[tuple[str, str, str], ...]] = (
    ("duration_s", "Duration", "{:.1f} s"),
    ("distance_m", "Distance", "{:.1f} m"),
    ("mean_speed_kmh", "Mean speed", "{:.1f} km/h"),
    ("max_speed_kmh", "Highest speed", "{:.1f} km/h"),
    ("speed_limit_kmh", "Speed limit", "{:.0f} km/h"),
    ("above_limit_s", "Time above the limit", "{:.2f} s"),
    ("lateral_rms_m", "Lateral error, RMS", "{:.4f} m"),
    ("lateral_p95_m", "Lateral error, 95 %", "{:.4f} m"),
    ("lateral_deviation_m", "Lateral position, standard deviation (SDLP)", "{:.4f} m"),
    ("lateral_max_m", "Lateral error, largest", "{:.4f} m"),
    ("lateral_max_at_m", "Largest error after", "{:.0f} m"),
    ("max_lateral_accel_mps2", "Highest lateral acceleration", "{:.2f} m/s²"),
)
"""Key of a figure in the metrics, what people read for it, and how it is written."""


def write_report(
    path: Path,
    drive: Drive,
    route: Route | None,
    title: str,
    extra: Mapping[str, object] | None = None,
    *,
    faults: Sequence[str] = (),
    latency_us: Mapping[str, Mapping[str, float]] | None = None,
) -> dict[str, Any]:
    """Write the report of a drive and return its metrics (metrics/drive_metrics.py).

    Args:
        path: the HTML file.
        drive: the drive.
        route: the theoretical path, None in a world without one.
        title: heading of the page.
        extra: further facts for the page, in order. Nothing that differs between equal drives belongs here, if two
            reports of one drive are to be equal.
        faults: names of the scenario's faults, in their order.
        latency_us: p50, p99, max and count of each hop (LatencyStatistics.summary_us). They differ between equal
            drives, so they are not among the metrics.

    Raises:
        RecordingError: a column is missing, or the file cannot be written.
    """
    way = track(drive, route)
    changes = mode_changes(drive, way)
    found = metrics(drive, route, way, faults, changes)
    svgs = map_svg(drive, way, changes, route), traces_svg(drive, way, changes, route)
    try:
        write_atomically(path, page(title, found, svgs, extra or {}, latency_us or {}))
    except OSError as error:
        raise RecordingError(f"{path}: cannot be written: {error.strerror}") from error
    return found


def page(
    title: str,
    found: Mapping[str, Any],
    svgs: Sequence[str],
    extra: Mapping[str, object],
    latency_us: Mapping[str, Mapping[str, float]],
) -> str:
    """Return the page's HTML."""
    parts = [
        f"<h1>{escape(title)}</h1>",
        '<p class="note">simconsole drive report. Lateral errors are those of base_link (centre of the rear axle) '
        "from the theoretical path, over every tick in which the autopilot drove, and over those in which the person "
        "did.</p>",
        _tiles(found),
        *(f"<figure>{svg}</figure>" for svg in svgs),
        "<h2>Metrics</h2>",
        _metrics_table(found),
        "<h2>Mode changes</h2>",
        _changes_table(found),
        *(("<h2>Take-overs</h2>", _takeovers_table(found)) if found["takeovers"] else ()),
        *(("<h2>On the road</h2>", _road_table(found)) if found["road"] else ()),
        *(("<h2>Speed advice</h2>", _advice_table(found["speed_advice"])) if found["speed_advice"] else ()),
        *(("<h2>Rules of the road</h2>", _rules_table(found)) if found["rules"] else ()),
        *(("<h2>Faults</h2>", _faults_table(found)) if found["faults"] else ()),
        *(("<h2>Own metrics</h2>", _own_table(found["own"])) if found.get("own") else ()),
        *(("<h2>Force feedback</h2>", _wheel_table(found["force_feedback"])) if found["force_feedback"] else ()),
        *(("<h2>Latency</h2>", _latency_table(latency_us)) if latency_us else ()),
        *(("<h2>Drive</h2>", _extra_table(extra)) if extra else ()),
    ]
    return html_page(title, parts)


def html_page(title: str, parts: Sequence[str]) -> str:
    """Return a whole page in the style of the reports; `parts` are HTML."""
    head = [
        "<!DOCTYPE html>",
        '<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width,initial-scale=1">',
        f"<title>{escape(title)}</title><style>{STYLE}</style></head><body>",
    ]
    return "\n".join((*head, *parts, "</body></html>", ""))


def _takeovers_table(found: Mapping[str, Any]) -> str:
    heads = "".join(f"<th class=n>{label}</th>" for _, label in _TAKEOVER)
    lines = [f"<table><tr><th class=n>tick</th><th>reason</th><th>asked</th>{heads}</tr>"]
    for record in found["takeovers"]:
        values = [record[key] for key, _ in _TAKEOVER]
        cells = "".join(f"<td class=n>{'-' if value is None else f'{value:.2f}'}</td>" for value in values)
        facts = f"<td>{escape(record['reason'])}</td><td>{'yes' if record['asked'] else 'no'}</td>"
        lines.append(f"<tr><td class=n>{record['tick']}</td>{facts}{cells}</tr>")
    return "\n".join((*lines, "</table>"))


def _tiles(found: Mapping[str, Any]) -> str:
    part = found["autonomous"] or {}
    shown = [
        (f"{found['distance_m'] / 1000.0:.2f} km", "driven in all"),
        (f"{found['duration_s']:.0f} s", "duration"),
    ]
    if part:
        shown.append((f"{part['distance_m'] / 1000.0:.2f} km", "by the autopilot"))
        shown.append((f"{part['mean_speed_kmh']:.1f} km/h", "mean speed of the autopilot"))
    if part.get("lateral_rms_m") is not None:
        shown.append((f"{part['lateral_rms_m'] * 100.0:.2f} cm", "lateral error, RMS"))
        shown.append((f"{part['lateral_max_m'] * 100.0:.2f} cm", "lateral error, largest"))
    return f"<ul class=tiles>{''.join(f'<li><b>{value}</b><span>{name}</span></li>' for value, name in shown)}</ul>"


def _metrics_table(found: Mapping[str, Any]) -> str:
    parts = (found, found["autonomous"] or {}, found["manual"] or {})
    lines = ["<table><tr><th></th><th class=n>whole drive</th><th class=n>autopilot</th><th class=n>person</th></tr>"]
    for key, label, form in METRICS:
        cells = (form.format(values[key]) if values.get(key) is not None else "-" for values in parts)
        lines.append(f"<tr><th>{label}</th>{''.join(f'<td class=n>{cell}</td>' for cell in cells)}</tr>")
    return "\n".join((*lines, "</table>"))


def _changes_table(found: Mapping[str, Any]) -> str:
    lines = [
        "<table><tr><th class=n>tick</th><th class=n>time</th><th class=n>driven</th><th>mode</th><th>reason</th></tr>"
    ]
    for change in found["mode_changes"]:
        mode = f"stays {change['mode']}" if change["refused"] else change["mode"]
        lines.append(
            f"<tr><td class=n>{change['tick']}</td><td class=n>{change['t_s']:.2f} s</td>"
            f"<td class=n>{change['distance_m']:.1f} m</td><td>{escape(mode)}</td>"
            f"<td>{escape(change['reason'])}</td></tr>"
        )
    return "\n".join((*lines, "</table>"))


def _advice_table(advice: Mapping[str, Any]) -> str:
    """Return whether advice was followed, and means for a light where it was and where not."""
    compliance = "-" if advice["compliance"] is None else f"{100.0 * advice['compliance']:.0f} %"
    lines = [
        f"<p>Advised before {advice['advised']} of {advice['lights']} lights; driven as advised: {compliance} of the"
        " time.</p>",
        "<table><tr><th>For a light, on average</th><th class=n>followed</th><th class=n>not, or none given</th></tr>",
    ]
    for key, label, form in _ADVICE:
        values = (advice[side][key] for side in ("followed", "not_followed"))
        cells = "".join(f"<td class=n>{'-' if value is None else form.format(value)}</td>" for value in values)
        lines.append(f"<tr><th>{label}</th>{cells}</tr>")
    return "\n".join((*lines, "</table>"))


def _road_table(found: Mapping[str, Any]) -> str:
    """Return what was met, and how many rules were broken in all: none is worth saying, too."""
    road = found["road"]
    lines = ["<table><tr><th></th><th class=n>whole drive</th><th class=n>autopilot</th><th class=n>person</th></tr>"]
    for key, label in _ROAD:
        cells = "".join(f"<td class=n>{road[side][key]}</td>" for side in ("whole", "autonomous", "manual"))
        lines.append(f"<tr><th>{label}</th>{cells}</tr>")
    lines.append(f"<tr><th>Rules broken</th><td class=n>{len(found['rules'])}</td><td></td><td></td></tr>")
    return "\n".join((*lines, "</table>"))


def _rules_table(found: Mapping[str, Any]) -> str:
    heads = "".join(f"<th class=n>{name}</th>" for name in ("from", "to", "driven", "highest speed", "limit"))
    lines = [f"<table><tr><th>broken rule</th>{heads}</tr>"]
    for event in found["rules"]:
        limit = "-" if event["limit_kmh"] is None else f"{event['limit_kmh']:.0f} km/h"
        cells = (
            f"{event['first_s']:.2f} s",
            f"{event['last_s']:.2f} s",
            f"{event['distance_m']:.1f} m",
            f"{event['top_speed_kmh']:.1f} km/h",
            limit,
        )
        values = "".join(f"<td class=n>{cell}</td>" for cell in cells)
        lines.append(f"<tr><td>{escape(RULES[event['rule']])}</td>{values}</tr>")
    return "\n".join((*lines, "</table>"))


def _faults_table(found: Mapping[str, Any]) -> str:
    lines = (
        f"<tr><td>{escape(span['fault'])}</td><td class=n>{span['first_s']:.3f} s</td>"
        f"<td class=n>{span['last_s']:.3f} s</td></tr>"
        for span in found["faults"]
    )
    head = "<table><tr><th>fault</th><th class=n>from</th><th class=n>to</th></tr>"
    return "\n".join((head, *lines, "</table>"))


def _wheel_table(wheel: Mapping[str, Any]) -> str:
    """Return how much of the car's torque the driver felt, and since when it was less than all."""
    least = f"{100.0 * wheel['least_share']:.0f} % at {wheel['least_at_kmh']:.0f} km/h"
    rows = [("Least share of the car's torque", least)]
    if wheel["eased_from_s"] is not None:
        rows.append(
            ("Eased for the wheel's stability", f"{wheel['eased_s']:.1f} s, from {wheel['eased_from_s']:.2f} s")
        )
    lines = (f"<tr><th>{name}</th><td>{value}</td></tr>" for name, value in rows)
    return "\n".join(("<table>", *lines, "</table>"))


def _own_table(own: Mapping[str, Mapping[str, float | None]]) -> str:
    """Return the figures of other packages' metrics, as they are called."""
    lines = (
        f"<tr><th>{escape(name)}</th><td>{escape(figure)}</td>"
        f"<td class=n>{'-' if value is None else f'{value:.6g}'}</td></tr>"
        for name, figures in own.items()
        for figure, value in figures.items()
    )
    return "\n".join(("<table><tr><th>metric</th><th>figure</th><th class=n>value</th></tr>", *lines, "</table>"))


def _latency_table(latency_us: Mapping[str, Mapping[str, float]]) -> str:
    lines = (
        f"<tr><td>{escape(hop)}</td>"
        + "".join(f"<td class=n>{page[key]:.1f}</td>" for key in ("p50", "p99", "max"))
        + f"<td class=n>{page['count']:.0f}</td></tr>"
        for hop, page in latency_us.items()
    )
    names = "".join(f"<th class=n>{name}</th>" for name in ("p50, µs", "p99, µs", "max, µs", "times"))
    return "\n".join((f"<table><tr><th>hop</th>{names}</tr>", *lines, "</table>"))


def _extra_table(extra: Mapping[str, object]) -> str:
    lines = [f"<tr><th>{escape(str(key))}</th><td>{escape(str(value))}</td></tr>" for key, value in extra.items()]
    return "\n".join(("<table>", *lines, "</table>"))
