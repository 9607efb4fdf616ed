import random

import pytest

from tests.scheduling import next_file

FILES = 40


def test_who_has_begun_goes_on() -> None:
    assert next_file([False, False, True, True], 1, {0}) == 2


def test_the_first_begins_at_the_start_and_the_second_in_the_middle() -> None:
    waiting = [True] * FILES
    assert next_file(waiting, None, set()) == 0
    waiting[0] = False
    assert next_file(waiting, None, {0}) == 1 + (FILES - 1) // 2


def test_a_stretch_that_nobody_goes_through_is_taken_from_its_start() -> None:
    assert next_file([False, True, True, False, True], 3 + 1, {3}) == 1


@pytest.mark.parametrize("processes", [1, 2, 3, 4])
@pytest.mark.parametrize("seed", range(5))
def test_each_file_is_taken_once_and_mostly_after_its_neighbour(processes: int, seed: int) -> None:
    """Whoever is faster: at most one jump for each halving of what is left."""
    draw = random.Random(seed)
    waiting, last, taken, jumps = [True] * FILES, dict[int, int](), list[int](), 0
    while any(waiting):
        process = draw.randrange(processes)
        others = {place for each, place in last.items() if each != process}
        place = next_file(waiting, last.get(process), others)
        jumps += place != last.get(process, place - 1) + 1
        waiting[place] = False
        last[process] = place
        taken.append(place)
    assert sorted(taken) == list(range(FILES))
    assert jumps <= FILES // 3
