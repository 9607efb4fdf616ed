"""ASAM OpenSCENARIO XML 1.x: a subset of it becomes a scenario; what is not understood is named."""
