"""`simconsole scenario`: scenarios of other formats."""
