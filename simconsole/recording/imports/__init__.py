"""Recordings of other systems as inputs of a drive: commands to play, traces of a driver."""
