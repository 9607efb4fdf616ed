"""What docs/validation.md is made from: our car beside CommonRoad's models, and analytic oracles."""
