"""The operators' view: state to shapes, shapes to rerun."""
