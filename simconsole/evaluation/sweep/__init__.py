"""Many drives of one plan: on this machine or on many, each in a process that may die, into one table."""
