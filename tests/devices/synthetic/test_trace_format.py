"""Traces: equal bits back, and every line that cannot be used refused with its number."""

import random
from pathlib import Path

import pytest

from simconsole.devices.sources.trace_files import TraceSource
from simconsole.devices.synthetic.trace_format import COLUMNS, row_text
from simconsole.values.errors import ProfileError
from simconsole.values.signals import NEVER_TICKS, DeviceSample
from tests.devices.traces import REST, written


def samples(count: int) -> list[DeviceSample]:
    dice = random.Random(7)
    print("seed 7")
    return [
        DeviceSample._make(
            (
                *(dice.uniform(-1, 1) for _ in range(5)),
                float(dice.getrandbits(13)),
                float(dice.getrandbits(10)),
                float(dice.randint(-1, 1)),
                float(dice.randint(-1, 1)),
                *(dice.choice([0.0, 3.0, NEVER_TICKS]) for _ in range(4)),
                float(dice.getrandbits(1)),
            )
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize("first", [1, 1000])
def test_recorded_samples_come_back_equal(first: int, tmp_path: Path) -> None:
    rows = samples(500)
    source = TraceSource(written(tmp_path / "trace.csv", rows, first), tick_hz=250)
    played = [source.poll(tick) for tick in range(1, 501)]
    source.close()
    assert [[value.hex() for value in row] for row in played] == [[value.hex() for value in row] for row in rows]


def test_after_its_end_a_trace_falls_silent(tmp_path: Path) -> None:
    source = TraceSource(written(tmp_path / "trace.csv", [REST, REST._replace(wheel_axis=0.5)]), tick_hz=250)
    ages = [source.poll(tick).pedals_age_ticks for tick in range(1, 6)]
    assert ages == [0.0, 0.0, 1.0, 2.0, 3.0]
    assert source.poll(40).wheel_axis == 0.5
    source.close()


def test_skipped_ticks_skip_rows(tmp_path: Path) -> None:
    rows = samples(10)
    source = TraceSource(written(tmp_path / "trace.csv", rows), tick_hz=250)
    assert [source.poll(tick) for tick in (1, 2, 7)] == [rows[0], rows[1], rows[6]]
    source.close()


def line(number: int, tick: int, **changes: float) -> str:
    return row_text(tick, REST._replace(**changes))


GOOD = f"# simconsole trace schema 1 tick_hz 250 cockpit test\n{','.join(COLUMNS)}\n"


@pytest.mark.fault("F06")
@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1"),
        ("hello\n", "line 1"),
        (GOOD.replace("schema 1", "schema 9"), "line 1: schema: value 9: 1"),
        (GOOD.replace("tick_hz 250", "tick_hz 100"), "line 1: tick_hz: value 100: 250"),
        (GOOD.replace("brake_axis,", ""), "line 2: columns: value brake_axis missing"),
        (GOOD.replace("hat_x,hat_y", "hat_y,hat_x"), "line 2: columns: value other columns"),
        (GOOD + line(3, 1) + line(4, 1), "line 4: tick: value 1: 2 (time goes back)"),
        (GOOD + line(3, 5) + line(4, 4), "line 4: tick: value 4: 6 (time goes back)"),
        (GOOD + line(3, 5) + line(4, 7), "line 4: tick: value 7: 6 (ticks are missing)"),
        (GOOD + line(3, 1, throttle_axis=float("nan")), "line 3: throttle_axis: value nan"),
        (GOOD + line(3, 1, wheel_axis=float("inf")), "line 3: wheel_axis: value inf"),
        (GOOD + line(3, 1, brake_axis=-1.2), "line 3: brake_axis: value -1.2"),
        (GOOD + line(3, 1, wheel_buttons=0.5), "line 3: wheel_buttons: value 0.5"),
        (GOOD + line(3, 1, hat_x=0.5), "line 3: hat_x"),
        (GOOD + line(3, 1, shifter_age_ticks=-1.0), "line 3: shifter_age_ticks"),
        (GOOD + line(3, 1) + line(4, 2)[:20], "line 4: value"),
        (GOOD + line(3, 1).replace("1.0", "fast", 1), "line 3: value"),
        (GOOD + "1" * 5000, "line 3: value longer than 1000"),
        (GOOD + "\u00e9\n", "value not ASCII"),
    ],
)
def test_line_that_cannot_be_used_is_named(text: str, message: str, tmp_path: Path) -> None:
    """F06."""
    path = tmp_path / "trace.csv"
    path.write_text(text)
    with pytest.raises(ProfileError) as caught:
        TraceSource(path, tick_hz=250)
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)
