"""Tool orientations for multi-axis machining of sculptured surfaces."""
