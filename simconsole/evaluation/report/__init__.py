"""Metrics, figures and the HTML report."""
