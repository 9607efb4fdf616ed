"""The simulated person at a virtual cockpit: this folder touches devices."""
