"""4+1 axes: one rotary axis is clamped and the other one turns along the passes."""
