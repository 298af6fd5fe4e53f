"""A dish, 40 x 30 mm, on a block: z = 12 + x^2/110 + y^2/90 - x y/300, hollow; `toolaxis demo` machines it."""

import numpy as np
from block import block, write


def square_control(half):
    """Bezier coefficients of t^2 over [-half, half]."""
    return np.array([half**2, -(half**2), half**2])


X, Y = np.meshgrid([-20.0, 0.0, 20.0], [-15.0, 0.0, 15.0], indexing="ij")
POINTS = np.stack([X, Y, 12 + square_control(20)[:, None] / 110 + square_control(15)[None, :] / 90 - X * Y / 300], -1)

if __name__ == "__main__":
    write("dish", block(POINTS, (2, 2), 0.0), POINTS, (2, 2), "made for this project")
