"""CAD kernels in: STEP files, Open CASCADE, CadQuery and build123d objects become parts."""

from toolaxis.cad.load import load

__all__ = ["load"]
