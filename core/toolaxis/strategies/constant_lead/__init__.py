"""A constant lead angle along each pass (Sturz milling)."""
