"""Passes as level sets of a field on a face, which follow the scallop height wherever it leads."""
