"""Parts of the profiles of vehicles and cockpits; they know no other profile."""
