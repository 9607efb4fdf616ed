"""An error of Dask in a module of its own: only who needs it loads Dask."""

from distributed.scheduler import KilledWorker


class Deadly(KilledWorker):
    """What Dask says of a task that has cost too many workers."""

    def __init__(self) -> None:
        Exception.__init__(self)

    def __str__(self) -> str:
        return "deadly"
