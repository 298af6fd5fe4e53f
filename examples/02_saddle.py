"""A saddle, 80 x 60 mm, on a block: z = 30 + x^2/180 - y^2/140, radii 90 and 70 mm in its middle."""

import numpy as np
from block import block, write


def square_control(half):
    """Bezier coefficients of t^2 over [-half, half]."""
    return np.array([half**2, -(half**2), half**2])


X, Y = np.meshgrid([-40.0, 0.0, 40.0], [-30.0, 0.0, 30.0], indexing="ij")
POINTS = np.stack([X, Y, 30 + square_control(40)[:, None] / 180 - square_control(30)[None, :] / 140], -1)

if __name__ == "__main__":
    write("saddle", block(POINTS, (2, 2), 0.0), POINTS, (2, 2), "made for this project")
