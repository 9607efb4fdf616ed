"""Dialogues that set a cockpit up."""
