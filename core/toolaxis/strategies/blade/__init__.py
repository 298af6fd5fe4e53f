"""Blades re-scheduled in the S-theta plane: the angle of the rotary axis over the length of each layer."""
