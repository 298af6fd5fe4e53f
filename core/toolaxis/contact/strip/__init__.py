"""How wide a pass cuts within the scallop height, and what the cutter leaves beside it."""
