"""The children of a paced drive: `python -m simconsole.processes supervisor` or `... worker`."""

import sys

from simconsole.processes import supervisor, worker

if __name__ == "__main__":
    sys.exit({"supervisor": supervisor.main, "worker": worker.main}[sys.argv[1]]())
