"""The panel that plans: its form, its result, and what it shows in the 3D view."""
