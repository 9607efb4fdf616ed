"""The tables of a report, as HTML. Pure: metrics in, text out."""

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import Any, Final

from simconsole.evaluation.metrics.rule_metrics import RULES
from simconsole.evaluation.report.metric_rows import ADVICE, METRICS, ROAD, TAKEOVER, MetricRow, definitions, rounded

_SIDES: Final = ("whole drive", "autopilot", "person")


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], words: int = 1) -> str:
    """Return a table; the first `words` columns are words, the others numbers. All texts are escaped here."""
    kinds = ("" if at < words else " class=n" for at in range(len(heads)))
    top = "".join(f"<th{kind}>{escape(head)}</th>" for kind, head in zip(kinds, heads, strict=True))
    lines = [f"<table><tr>{top}</tr>"]
    for row in rows:
        cells = (f"<td{'' if at < words else ' class=n'}>{escape(cell)}</td>" for at, cell in enumerate(row))
        lines.append(f"<tr>{''.join(cells)}</tr>")
    return "\n".join((*lines, "</table>"))


def facts_table(facts: Mapping[str, object]) -> str:
    """Return a table of names and texts."""
    lines = (f"<tr><th>{escape(str(key))}</th><td>{escape(str(value))}</td></tr>" for key, value in facts.items())
    return "\n".join(("<table>", *lines, "</table>"))


def sides_table(rows: Sequence[MetricRow], heads: Sequence[str], sides: Sequence[Mapping[str, Any]]) -> str:
    """Return a line for each figure with its value on each side."""
    lines = [f"<table><tr><th>figure</th>{''.join(f'<th class=n>{escape(head)}</th>' for head in heads)}</tr>"]
    for row in rows:
        cells = "".join(f"<td class=n>{row.written(side.get(row.key))}</td>" for side in sides)
        lines.append(f"<tr><th>{escape(row.label)}</th>{cells}</tr>")
    return "\n".join((*lines, "</table>"))


def metrics_table(found: Mapping[str, Any]) -> str:
    """Return the figures of the whole drive and of what each side drove."""
    return sides_table(METRICS, _SIDES, (found, found["autonomous"] or {}, found["manual"] or {}))


def changes_table(found: Mapping[str, Any]) -> str:
    """Return every change of mode and every refusal."""
    rows = (
        (
            f"stays {change['mode']}" if change["refused"] else change["mode"],
            change["reason"],
            f"{change['t_s']:.2f} s",
            f"{rounded(change['distance_m'])} m",
            str(change["tick"]),
        )
        for change in found["mode_changes"]
    )
    return table(("mode", "reason", "time", "driven", "tick"), rows, words=2)


def marks_table(found: Mapping[str, Any], acts: Sequence[Mapping[str, Any]], tick_hz: int) -> str:
    """Return who marked which moment, and what operators wrote; `acts` are those of the drive's summary."""
    rows = [(mark["tick"], mark["by"], "", f"{rounded(mark['distance_m'])} m") for mark in found["marks"]]
    for act in acts:
        known = (f"{key} {act[key]}" for key in ("participant", "trial") if act.get(key))
        said = ", ".join((*known, *([act["note"]] if act.get("note") else [])))
        if said:
            rows.append((int(act["tick"]), f"operator: {act['act']}", said, ""))
    ordered = ((by, said, f"{tick / tick_hz:.2f} s", way, str(tick)) for tick, by, said, way in sorted(rows))
    return table(("by", "note", "time", "driven", "tick"), ordered, words=2)


def takeovers_table(found: Mapping[str, Any]) -> str:
    """Return how each take-over went."""
    rows = (
        (
            record["reason"],
            "yes" if record["asked"] else "no",
            str(record["tick"]),
            *("-" if record[row.key] is None else f"{record[row.key]:.2f}" for row in TAKEOVER),
        )
        for record in found["takeovers"]
    )
    return table(("reason", "asked", "tick", *(row.label for row in TAKEOVER)), rows, words=2)


def advice_table(advice: Mapping[str, Any]) -> str:
    """Return whether advice was followed, and means for a light where it was and where not."""
    compliance = "-" if advice["compliance"] is None else f"{100.0 * advice['compliance']:.0f} %"
    said = (
        f"Advised before {advice['advised']} of {advice['lights']} lights; driven as advised: {compliance} of the time."
    )
    heads = ("followed", "not, or none given")
    return f"<p>{said}</p>\n{sides_table(ADVICE, heads, (advice['followed'], advice['not_followed']))}"


def road_table(found: Mapping[str, Any]) -> str:
    """Return what was met, and how many rules were broken in all: none is worth saying, too."""
    road = found["road"]
    sides = [{key: road[side][key] for key in road[side]} for side in ("whole", "autonomous", "manual")]
    broken = MetricRow("rules", "Rules broken", "", "")
    return sides_table((*ROAD, broken), _SIDES, ({**sides[0], "rules": len(found["rules"])}, *sides[1:]))


def rules_table(found: Mapping[str, Any]) -> str:
    """Return every breach of a rule."""
    rows = (
        (
            RULES[event["rule"]],
            f"{event['first_s']:.2f} s",
            f"{event['last_s']:.2f} s",
            f"{rounded(event['distance_m'])} m",
            f"{event['top_speed_kmh']:.1f} km/h",
            "-" if event["limit_kmh"] is None else f"{event['limit_kmh']:.0f} km/h",
        )
        for event in found["rules"]
    )
    return table(("broken rule", "from", "to", "driven", "highest speed", "limit"), rows)


def faults_table(found: Mapping[str, Any]) -> str:
    """Return when which fault was on."""
    rows = ((span["fault"], f"{span['first_s']:.3f} s", f"{span['last_s']:.3f} s") for span in found["faults"])
    return table(("fault", "from", "to"), rows)


def wheel_table(wheel: Mapping[str, Any]) -> str:
    """Return how much of the car's torque the driver felt, and since when it was less than all."""
    least = f"{100.0 * wheel['least_share']:.0f} % at {wheel['least_at_kmh']:.0f} km/h"
    facts = {"Least share of the car's torque": least}
    if wheel["eased_from_s"] is not None:
        facts["Eased for the wheel's stability"] = f"{wheel['eased_s']:.1f} s, from {wheel['eased_from_s']:.2f} s"
    return facts_table(facts)


def own_table(own: Mapping[str, Mapping[str, float | None]]) -> str:
    """Return the figures of other packages' metrics, as they are called."""
    rows = [
        (name, figure, "-" if value is None else f"{value:.6g}")
        for name, figures in own.items()
        for figure, value in figures.items()
    ]
    return table(("metric", "figure", "value"), rows, words=2)


def latency_table(latency_us: Mapping[str, Mapping[str, float]]) -> str:
    """Return how long each hop took."""
    rows = (
        (hop, *(rounded(page[key]) for key in ("p50", "p99", "max")), f"{page['count']:.0f}")
        for hop, page in latency_us.items()
    )
    return table(("hop", "p50, µs", "p99, µs", "max, µs", "times"), rows)


def definitions_list(found: Mapping[str, Any]) -> str:
    """Return what each figure of the page means."""
    items = (f"<dt>{escape(label)}</dt><dd>{escape(meaning)}</dd>" for label, meaning in definitions(found))
    return f"<dl>{''.join(items)}</dl>"
