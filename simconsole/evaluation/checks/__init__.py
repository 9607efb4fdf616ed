"""Scripted-input regression."""
