from collections.abc import Callable

from simconsole.bridge.tools.bench_load import load


def test_bad_clients_are_measured(record_property: Callable[[str, object], None]) -> None:
    found = load(seconds=0.5)
    assert found.lost == 0
    assert found.growth_mb < 10.0
    assert found.sent_hz > 0.0
    assert 0.0 <= found.age_p50_ms <= found.age_p99_ms <= found.age_max_ms
    record_property("load", str(found))
