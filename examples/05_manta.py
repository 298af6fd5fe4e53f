"""The Manta surface, 600 x 600 mm: [grandguillaume2021], Appendix C, a Bezier patch of degree (3, 3)."""

import numpy as np
from block import face, write

X, Y = np.meshgrid([0.0, 200.0, 400.0, 600.0], [0.0, 200.0, 400.0, 600.0], indexing="ij")
POINTS = np.stack([X, Y, np.where((X > 300) != (Y > 300), 100.0, 0.0)], axis=-1)

if __name__ == "__main__":
    write("manta", face(POINTS, (3, 3)), POINTS, (3, 3), "grandguillaume2021, Appendix C")
