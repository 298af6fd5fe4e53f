"""Whether an axis may be used on a face: interference, the cone of its normals, and the points that are looked at."""
