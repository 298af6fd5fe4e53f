"""Cutter location data: plain arrays that know nothing of how they were made."""
