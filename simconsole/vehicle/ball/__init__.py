"""The ball of the roll-a-ball example: the second platform, as unlike a car as can be."""
