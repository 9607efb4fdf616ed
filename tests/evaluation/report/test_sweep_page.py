from pathlib import Path

import numpy as np

from simconsole.evaluation.report.sweep_page import distributions, write_sweep_page
from simconsole.evaluation.sweep.task import TaskResult
from tests.evaluation.sweep.plans import grip

VALUES = (3.0, 1.0, 8.0, 2.0)


def found() -> dict[int, TaskResult]:
    return {
        index: TaskResult(index=index, outcome="driven", metrics={"a_m": value, "same_s": 4.0})
        for index, value in enumerate(VALUES)
    }


def test_of_each_metric_that_varies_the_worst_cases_are_named() -> None:
    (only,) = distributions(found())
    assert (only.name, only.largest, only.smallest) == ("a_m", 2, 1)
    assert np.array_equal(only.values, VALUES)


def test_the_page_names_worst_cases_losses_and_how_to_drive_one_again(tmp_path: Path) -> None:
    plan = grip(tmp_path, 5, title="<grip>")
    results = found() | {4: TaskResult(index=4, outcome="crashed", detail="twice & gone")}
    write_sweep_page(tmp_path / "sweep.html", plan, results, lambda index: f"again {index} & replay")
    page = (tmp_path / "sweep.html").read_text()
    assert "&lt;grip&gt;" in page
    for index, what in ((1, "least a_m"), (2, "most a_m")):
        assert f"<td>{what}</td><td><code>again {index} &amp; replay</code></td></tr>" in page
    assert "<td>twice &amp; gone</td><td><code>again 4 &amp; replay</code></td></tr>" in page
    assert page.count("<code>") == 3
    assert "twice &amp; gone" in page
    assert 'title="session, environment.friction 0.6">2</td>' in page
    assert 'aria-label="distribution of a_m"' in page
    assert 'd="M0 28H0.0V21.0H17.1V14.0H34.3V7.0H120.0V0.0"' in page  # 1, 2, 3 and 8, a quarter of the drives each
    assert page == (tmp_path / "sweep.html").read_text()
