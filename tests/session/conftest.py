"""Workers in these tests are watched like those of tests/processes."""

from tests.processes.conftest import is_running, programs, run_base, wait_until

__all__ = ["is_running", "programs", "run_base", "wait_until"]
