"""Vectors inside kernels: tuples of three numbers, which stay in registers."""

from typing import TypeAlias

from toolaxis.numeric.jit import jit_uncounted_inline

Triple: TypeAlias = tuple[float, float, float]


@jit_uncounted_inline
def dot(x: Triple, y: Triple) -> float:
    """Scalar product."""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


@jit_uncounted_inline
def cross(x: Triple, y: Triple) -> Triple:
    """Vector product."""
    return x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]


@jit_uncounted_inline
def plus(x: Triple, y: Triple, share: float) -> Triple:
    """x + share y."""
    return x[0] + share * y[0], x[1] + share * y[1], x[2] + share * y[2]


@jit_uncounted_inline
def combine(x: Triple, a: float, y: Triple, b: float) -> Triple:
    """a x + b y."""
    return a * x[0] + b * y[0], a * x[1] + b * y[1], a * x[2] + b * y[2]
