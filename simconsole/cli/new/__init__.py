"""`simconsole new`: templates that run at once, each with a test beside it."""
