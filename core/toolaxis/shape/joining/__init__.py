"""Faces that continue each other smoothly, joined into one surface."""
