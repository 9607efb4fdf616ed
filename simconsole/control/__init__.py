"""Who drives: the mode table, arbitration and the last gate."""
