"""CAD kernels in: STEP files, Open CASCADE, CadQuery and build123d objects become parts."""

from toolaxis.cad.loading import load

__all__ = ["load"]
