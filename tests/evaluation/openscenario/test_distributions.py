"""Files of parameter values, as scenariogeneration writes them and by hand."""

import random
from pathlib import Path
from typing import Any

import pytest

from simconsole.evaluation.openscenario.distributions import MOST_SETS, value_sets
from simconsole.values.errors import ProfileError
from tests.evaluation.openscenario.files import NAMED, file_of, mutated, single, span, xosc
from tests.samples import Sample

SETS = """
<DeterministicMultiParameterDistribution><ValueSetDistribution>
  <ParameterValueSet>
    <ParameterAssignment parameterRef="gap" value="20"/><ParameterAssignment parameterRef="kind" value="van"/>
  </ParameterValueSet>
  <ParameterValueSet><ParameterAssignment parameterRef="gap" value="40"/></ParameterValueSet>
</ValueSetDistribution></DeterministicMultiParameterDistribution>
"""


def written(folder: Path, *axes: tuple[str, Any]) -> bytes:
    """A file by scenariogeneration."""
    found = xosc().Deterministic()
    for name, axis in axes:
        found.add_single_distribution(name, axis)
    path = folder / "values.xosc"
    xosc().ParameterValueDistribution("values", "nobody", "cut_in.xosc", found).write_xml(str(path))
    return path.read_bytes()


def refusal(content: bytes) -> str | None:
    """Why a file is refused, None if it is read; any other exception is one."""
    try:
        assert 1 <= len(value_sets(content, "made.xosc")) <= MOST_SETS
    except ProfileError as error:
        return str(error)
    return None


def test_every_combination_comes_in_the_order_of_the_file(tmp_path: Path) -> None:
    speeds = xosc().DistributionSet()
    speeds.add_value("6")
    speeds.add_value("8")
    content = written(tmp_path, ("speed", speeds), ("gap", xosc().DistributionRange(0.1, xosc().Range(0, 0.3))))
    found = value_sets(content, "values.xosc")
    gaps = ["0", "0.1", "0.2", "0.3"]
    assert found == [{"speed": speed, "gap": gap} for speed in ("6", "8") for gap in gaps]


def test_sets_of_several_parameters_stay_together() -> None:
    found = value_sets(file_of(span(1, 2, 1), SETS), "values.xosc")
    sets: list[dict[str, str]] = [{"gap": "20", "kind": "van"}, {"gap": "40"}]
    assert found == [{"speed": speed, **one} for speed in ("1", "2") for one in sets]


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (file_of(within="Stochastic"), "line 1: <Stochastic>: not understood"),
        (file_of(single("<UserDefinedDistribution/>")), "line 1: <UserDefinedDistribution>: not understood"),
        (file_of(span(0, 1, 0)), "line 1: <DistributionRange>: stepWidth: value 0: a number from 1e-09"),
        (file_of(span(2, 1, 1)), "line 1: <Range>: upperLimit: value 1: a number from 2"),
        (file_of(span(0, 1e6, 1)), "line 1: <DistributionRange>: more than 1000 values"),
        (file_of(span(1, 99, 1), span(1, 99, 1)), "line 1: <ParameterValueDistribution>: 9801 sets of values: 1 to"),
        (file_of(single("<DistributionSet/>")), "line 1: <ParameterValueDistribution>: 0 sets of values: 1 to 1000"),
        (b"<OpenSCENARIO><FileHeader/></OpenSCENARIO>", "<ParameterValueDistribution>: value missing"),
    ],
)
def test_what_is_no_list_of_values_is_refused_by_its_name_and_line(content: bytes, told: str) -> None:
    with pytest.raises(ProfileError) as error:
        value_sets(content, "values.xosc")
    assert str(error.value).startswith(f"values.xosc: {told}")


def test_mutations_are_read_or_refused_with_the_element(sample: Sample) -> None:
    rng, content = random.Random(sample.seed), file_of(span(1, 3, 1), SETS)
    told = [refusal(mutated(content, rng)) for _ in range(sample.of(100, 3000))]
    refused = [one for one in told if one is not None]
    assert len(refused) > 20
    for one in refused:
        assert NAMED.match(one), one
        assert "\n" not in one
