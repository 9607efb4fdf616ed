"""Which process of a run gets which test file: each goes through a stretch of the tree of its own.

Files beside each other import the same modules, load the same kernels and keep the same caches. Where all processes
take turns at one list, each of them comes to hold all of that. One that has become large all the same ends after the
files that it has, and a fresh one takes its place.
"""

from collections.abc import Collection, Sequence
from itertools import groupby

import pytest
from xdist.remote import Producer
from xdist.scheduler import LoadFileScheduling
from xdist.workermanage import WorkerController


class Stretches(LoadFileScheduling):  # type: ignore[misc]  # xdist has no types
    """xdist's scheduler of whole files, but for the order in which each process gets them and for how long it lives."""

    def __init__(self, config: pytest.Config, log: Producer) -> None:
        """Nobody has taken a file."""
        super().__init__(config, log)
        self._files: list[str] = []
        self._last: dict[WorkerController, int] = {}
        self._retired: set[WorkerController] = set()

    def retire(self, node: WorkerController) -> None:
        """Give `node` no more files, if there are any: it ends after those that it has."""
        if self.workqueue and node not in self._retired:
            self._retired.add(node)
            node.shutdown()

    def replace(self, node: WorkerController) -> None:
        """Let the process of `node`, which has no tests left, end if it was retired; start one for the files left."""
        if node in self._retired:
            node.gateway.exit()  # xdist keeps it until the end of the run
            if self.workqueue:
                self.config.pluginmanager.getplugin("dsession")._clone_node(node)

    def remove_node(self, node: WorkerController) -> str | None:
        """Leave the stretch of `node`, and return the test in which it died, as xdist wants it."""
        self._last.pop(node, None)
        crashed: str | None = super().remove_node(node)
        return crashed

    def _reschedule(self, node: WorkerController) -> None:
        """Give `node` its next file in time; not to one that still collects, for others do not wait for it."""
        if node in self.registered_collections:
            super()._reschedule(node)

    def _assign_work_unit(self, node: WorkerController) -> None:
        """Give `node` its next file."""
        self._files = self._files or list(self.workqueue)
        waiting = [file in self.workqueue for file in self._files]
        others = {last for each, last in self._last.items() if each is not node}
        self._last[node] = next_file(waiting, self._last.get(node), others)
        self.workqueue.move_to_end(self._files[self._last[node]], last=False)
        super()._assign_work_unit(node)


def scheduler_of(node: WorkerController) -> Stretches | None:
    """Return what schedules a process of this run, where it is ours."""
    scheduler = node.config.pluginmanager.getplugin("dsession").sched
    return scheduler if isinstance(scheduler, Stretches) else None


def next_file(waiting: Sequence[bool], last: int | None, others: Collection[int]) -> int:
    """Return the place of the file that a process takes next.

    `waiting` tells of each file whether nobody has taken it (of one at least), `last` where this process is and
    `others` where all others are. It goes on where it is. At the end of its stretch it takes the longest that is left:
    its second half, where somebody goes through it already.
    """
    if last is not None and last + 1 < len(waiting) and waiting[last + 1]:
        return last + 1
    stretches = [list(places) for left, places in groupby(range(len(waiting)), waiting.__getitem__) if left]
    longest = max(stretches, key=len)
    return longest[len(longest) // 2] if longest[0] - 1 in others else longest[0]
