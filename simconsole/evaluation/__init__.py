"""Evaluation of drives: checks, manoeuvres, metrics, report."""
