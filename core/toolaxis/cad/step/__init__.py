"""STEP files: what their text says, what is damaged in it, and the reading of them in a process of its own."""
