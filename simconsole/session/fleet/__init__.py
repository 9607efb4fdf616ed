"""Several platforms in one session: each with its own state, commander and recording, on one rosbridge server."""
