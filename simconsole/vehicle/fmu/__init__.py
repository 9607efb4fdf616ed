"""Functional mock-up units as vehicles, by fmpy (extra `fmu`)."""
