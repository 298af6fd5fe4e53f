"""A strongly waved freeform face, 100 x 100 mm, on a block: look-alike of [zhu2016] Fig. 14.

The original takes nine sub-surfaces; its shape is not published.  This one has its area (11684 mm of ball-end passes
some 0.98 mm apart), and normals up to 47 degrees from upright, so that a torus on one fixed axis is no good; hollows of
13 mm radius let the cutter in.
"""

import numpy as np
from block import block, write

X, Y = np.meshgrid(np.linspace(-50, 50, 9), np.linspace(-50, 50, 9), indexing="ij")
WAVE = 2 * np.pi / 72
Z = 40 + 11 * np.sin(WAVE * X + 0.4) * np.cos(0.85 * WAVE * Y - 0.3) + 5 * np.sin(4 / 7 * WAVE * (X + Y))
POINTS = np.stack([X, Y, np.round(Z, 1)], -1)

#: Cutter, scallop height in mm and what [zhu2016] Tables 3 and 4 print for the original.
FACTS = {"look_alike": "zhu2016 Fig. 14", "tool": "torus:12x1", "scallop": 0.02,
         "published": {"passes": [19, 31, 35, 30, 19, 10, 14, 5, 10], "passes_romans_rule_s4": 71,
                       "length_five_axis": 3927.03, "length_one_axis": 8976.06, "length_indexed": 5720.1,
                       "length_ball": 11684.1, "feedrate_mm_per_min": 3000}}

if __name__ == "__main__":
    write("waves", block(POINTS, (3, 3), 0.0), POINTS, (3, 3), "made for this project", **FACTS)
