"""Built-in traffic: vehicles that follow, change lanes, give way and obey signals on a road map."""
