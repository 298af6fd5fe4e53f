"""The biquintic Bezier patch of [jang2021], Table 1, its hollow side out of the material.

The table's columns run along u; its rows, from the last to the first, along v, so that Su x Sv points up.
"-19..12" of the table is -19.12.  Least radius of curvature 28.248 mm, box 187.543 x 124.131 x 43.006 mm.
"""

import numpy as np
from block import face, write

X = np.array([[-33.153, 24.843, 74.154, 113.219, 140.483, 154.39],
              [-33.153, 24.844, 74.154, 113.219, 140.484, 154.39],
              [-33.153, 24.843, 74.154, 113.219, 140.484, 154.39],
              [-33.153, 24.844, 74.154, 113.219, 140.484, 154.39],
              [-33.153, 24.844, 74.154, 113.219, 140.484, 154.39],
              [-33.153, 24.843, 74.154, 113.219, 140.484, 154.39]])
Y = np.array([88.38, 67.235, 40.568, 12.061, -14.606, -35.751])
SECTION = np.array([0.0, -15.284, -22.927, -22.927, -15.284, 0.0])
Z = np.array([SECTION, [-19.12, -34.405, -42.047, -42.047, -34.405, -19.12],
              [-28.68, -43.965, -51.607, -51.607, -43.965, -28.68],
              [-28.68, -43.965, -51.607, -51.607, -43.965, -28.68],
              [-19.12, -34.405, -42.047, -42.047, -34.405, -19.12], SECTION])
POINTS = np.stack([X, np.repeat(Y[:, None], 6, axis=1), Z], axis=-1)[::-1].transpose(1, 0, 2)

if __name__ == "__main__":
    write("biquintic", face(POINTS, (5, 5)), POINTS, (5, 5), "jang2021, Table 1")
