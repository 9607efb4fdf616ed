"""Rules of the road: what signals show when, what lies ahead of the vehicle, and which rules it breaks. Pure."""
