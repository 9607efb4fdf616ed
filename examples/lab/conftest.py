"""Scenario files of this repository are tests: *.scenario.yaml."""

pytest_plugins = ["simconsole.evaluation.checks.pytest_plugin"]
