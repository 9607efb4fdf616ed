"""A recorded drive in formats of others: one module for each, and one registry (`export_formats`)."""
