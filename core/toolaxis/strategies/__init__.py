"""Ways to move the axis along the passes of a face, a folder each, and what they share."""
