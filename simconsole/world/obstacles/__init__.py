"""Fixed things beside a road, and what they do to a vehicle that runs into them."""
