"""What a drive was worth: checks, manoeuvres, metrics, report."""
