"""Into sub-surfaces: where to divide faces so that fixed axes cut them in the least length."""
