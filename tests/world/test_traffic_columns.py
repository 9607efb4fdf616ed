from simconsole.world import traffic_columns as at
from tests.world.traffic.made import path_on


def test_columns_do_not_overlap() -> None:
    values = [value for name, value in vars(at).items() if name.isupper() and name not in ("BOX", "VALUES")]
    slots = [at.COUNT, at.DRAW, at.LANES, at.CONNECTIONS, at.GRANTS, at.SLOTS, at.PATH]
    boxes = sorted(set(values) - set(slots) | {0, 1, 2})
    assert boxes[: at.VALUES] == list(range(at.VALUES))
    assert at.PATH == 2 + 3 * at.SLOTS


def test_draws_of_a_vehicle_are_its_own_and_cover_all_choices() -> None:
    one, other = path_on(0), path_on(0)
    other[at.DRAW] = 77
    first, second = ([at.drawn(path, 3) for _ in range(300)] for path in (one, other))
    assert first != second
    assert all(60 < first.count(choice) < 140 for choice in range(3))
    assert 0 <= one[at.DRAW] < 2**31
