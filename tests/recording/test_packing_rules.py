import numpy as np

from simconsole.recording.packing import Coded, Constant, Copy, Plain, Rule, pack, problem, unpack
from simconsole.recording.packing_rules import MAX_SAMPLES, SAMPLE_TICKS, RuleFinder
from tests.bits import difference

TICKS = 4096


def found(columns: dict[str, np.ndarray], block: int = 1024) -> dict[str, Rule]:
    vectors = np.column_stack(list(columns.values()))
    finder = RuleFinder(tuple(columns))
    for start in range(0, len(vectors), block):
        finder.add(vectors[start : start + block])
    rules = finder.rules()
    assert tuple(rules) == tuple(columns)
    assert problem(rules) is None
    for start in range(0, len(vectors), block):
        part = vectors[start : start + block]
        assert not difference(unpack(rules, pack(rules, part), tuple(rules), len(part)), part)
    return rules


def noise(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=TICKS)


def test_constants_and_copies_are_left_out() -> None:
    first = noise(1)
    rules = found({"a": first, "b": np.full(TICKS, -0.0), "c": first, "d": noise(2)})
    assert rules["b"] == Constant(int(np.array(-0.0).view(np.int64)))
    assert rules["c"] == Copy("a")
    assert isinstance(rules["d"], Plain | Coded)


def test_what_differs_in_one_bit_of_one_tick_is_no_copy_and_no_constant() -> None:
    first = noise(1)
    near, zeros = first.copy(), np.zeros(TICKS)
    near[3000] = np.nextafter(near[3000], np.inf)
    zeros[3000] = -0.0
    rules = found({"vehicle.x_m": first, "sample.near": near, "sample.zeros": zeros})
    assert not isinstance(rules["sample.near"], Copy)
    assert not isinstance(rules["sample.zeros"], Constant)


def test_nans_of_other_payloads_are_no_copies() -> None:
    quiet = np.full(TICKS, np.nan)
    other = (quiet.view(np.int64) + 1).view(np.float64)
    rules = found({"a": quiet, "b": other, "c": quiet})
    assert rules["a"] != rules["b"]
    assert rules["a"] == rules["c"]


def test_a_copy_of_the_tick_before_is_coded_by_it_whatever_it_is_called() -> None:
    walk = np.cumsum(noise(3))
    rules = found({"vehicle.x_m": walk, "command.target_x_m": np.concatenate([[7.0], walk[:-1]])})
    assert rules["command.target_x_m"] == Coded(0, "vehicle.x_m", 1)
    assert rules["vehicle.x_m"] == Plain()


def test_a_counter_costs_next_to_nothing() -> None:
    rules = found({"memory.count": np.arange(5.0, 5.0 + TICKS), "a": noise(1)})
    counter = rules["memory.count"]
    assert isinstance(counter, Coded)
    kept = pack(rules, np.column_stack([np.arange(5.0, 5.0 + TICKS), noise(1)]))["memory.count"]
    assert (kept[16:] == 0).mean() > 0.98


def test_smooth_inner_state_is_coded_and_what_people_read_is_plain() -> None:
    smooth = np.sin(np.arange(TICKS) * 0.001) * 3.0
    rules = found({"platform.x_m": smooth, "vehicle.x_m": smooth * 1.7})
    assert isinstance(rules["platform.x_m"], Coded)
    assert rules["vehicle.x_m"] == Plain()


def test_no_rules_refer_in_a_circle() -> None:
    """Each of three that are alike is best coded by another one."""
    walk = np.cumsum(noise(3))
    near = {f"platform.{index}": (walk.view(np.int64) + index).view(np.float64) for index in range(3)}
    rules = found(near)
    assert sum(isinstance(rule, Coded) and rule.reference is not None for rule in rules.values()) == 2


def test_drives_too_short_to_judge_are_plain() -> None:
    assert found({"platform.x_m": np.array([1.0, 2.0])}) == {"platform.x_m": Plain()}
    assert RuleFinder(("a", "b")).rules() == {"a": Plain(), "b": Plain()}


def test_samples_do_not_grow_with_the_drive() -> None:
    finder = RuleFinder(("a",))
    for index in range(20 * MAX_SAMPLES):
        finder.add(np.full((SAMPLE_TICKS, 1), float(index)))
    kept = [float(sample[0, 0:1].view(np.float64)[0]) for sample in finder._samples]
    assert MAX_SAMPLES <= len(kept) <= 2 * MAX_SAMPLES
    assert np.diff(kept).tolist() == [kept[1] - kept[0]] * (len(kept) - 1)  # spread evenly
    assert 20 * MAX_SAMPLES - kept[-1] <= kept[1] - kept[0], "to the end of the drive"
