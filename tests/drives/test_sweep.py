"""Sweeps as people start them: equal files from every engine, and from one that was killed and went on."""

from pathlib import Path

from simconsole.evaluation.sweep.journal import JOURNAL
from simconsole.evaluation.sweep.results import RESULTS
from tests.drives.console import Running, patient, results
from tests.evaluation.sweep.clusters import cluster, kill, pool_workers_of
from tests.evaluation.sweep.plans import write_plan
from tests.patience import PATIENCE_S, wait_until
from tests.samples import Sample


def plan_of(folder: Path, sample: Sample) -> Path:
    """20 drives of 20 s, or 1,000."""
    seconds, rows = 20.0, sample.of(2, 100)
    low = 0.2 + sample.seed % 1000 / 5000.0
    values = {
        "environment.friction": {"from": low, "to": 1.0, "count": rows},
        "body.mass_kg": {"from": 1100, "to": 1700, "count": 10},
    }
    return write_plan(folder, values=values, duration_s=seconds)


def test_every_engine_writes_the_same_file_and_a_killed_sweep_goes_on(tmp_path: Path, sample: Sample) -> None:
    plan, count = plan_of(tmp_path, sample), sample.of(20, 1000)
    patience_s = sample.of(1, 10) * PATIENCE_S
    here = patient(patience_s, "sweep", plan, "--jobs", 2, "--out", tmp_path / "here", "--json")
    assert here.returncode == 0, here.stderr
    assert results(here)["outcomes"] == {"driven": count}
    whole = (tmp_path / "here" / RESULTS).read_bytes()
    for workers in (1, 2)[: sample.of(1, 2)]:
        folder = tmp_path / f"dask-{workers}"
        folder.mkdir()
        with cluster(folder, workers) as there:
            words = ("sweep", plan, "--engine", "dask", "--scheduler", there.url, "--out", folder)
            done = patient(patience_s, *words)
            assert done.returncode == 0, done.stderr
        assert (folder / RESULTS).read_bytes() == whole
    assert (killed_and_gone_on(tmp_path, plan, count, patience_s) / RESULTS).read_bytes() == whole


def killed_and_gone_on(tmp_path: Path, plan: Path, count: int, patience_s: float) -> Path:
    """Kill a sweep after a third of its drives, and start it again; its folder."""
    folder = tmp_path / "killed"
    journal = folder / JOURNAL
    with Running(tmp_path, "sweep", plan, "--jobs", 2, "--out", folder) as running:
        wait_until(lambda: journal.exists() and journal.read_bytes().count(b"\n") > count // 3, "a third of the drives")
        lanes = pool_workers_of(running.process.pid)
        kill(running.process.pid)
        running.end()
    assert len(lanes) == 3, "the first and its two copies"
    wait_until(lambda: not any(Path(f"/proc/{lane}").exists() for lane in lanes), "the lanes' end")
    assert not (folder / RESULTS).exists()
    assert patient(patience_s, "sweep", plan, "--jobs", 2, "--out", folder).returncode == 0
    rows = journal.read_bytes().splitlines()[1:]
    assert len(rows) == len({row.partition(b",")[0] for row in rows}) == count, "no double rows, none missing"
    return folder
