"""Trees of cells around faces, with bounds that hold."""
