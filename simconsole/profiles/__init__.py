"""Typed profiles with bounds and defaults; simconsole.profiles.files.loader reads them."""
