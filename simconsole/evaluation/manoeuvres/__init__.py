"""Test manoeuvres: how each is driven, and which characteristic values a drive of it has. Pure."""
