"""Typed profiles with bounds and defaults; simconsole.profile_files reads them."""
