"""Logs and bundles in their folders."""
