"""A bicubic freeform patch, 100 x 70 mm, on a block: hollows, humps and saddles in one face.

It stands for sub-surface S4 of [zhu2016], whose data are not published.
"""

import numpy as np
from block import block, write

X, Y = np.meshgrid(np.linspace(-50, 50, 6), np.linspace(-35, 35, 5), indexing="ij")
POINTS = np.stack([X, Y, np.round(40 + 6 * np.sin(X / 24 + Y / 60) + 5 * np.sin(Y / 20) * np.cos(X / 70), 1)], -1)

if __name__ == "__main__":
    write("freeform", block(POINTS, (3, 3), 0.0), POINTS, (3, 3), "made for this project")
