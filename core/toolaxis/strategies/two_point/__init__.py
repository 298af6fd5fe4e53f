"""Flat ends that touch the surface at two points: tilts, strips and passes."""
