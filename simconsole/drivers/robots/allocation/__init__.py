"""Which robot does which tasks, in which order: the exact optimum and two methods without proof."""
