"""Parts with blades: which faces make a blade, what of them is exposed, and how far neighbours are away."""
