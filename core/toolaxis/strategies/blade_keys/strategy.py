"""The strategy `blade-keys`: as `blade`, with tool angles by key points and rounded corners."""

from toolaxis.strategies.blade.strategy import BladeStrategy


class BladeKeys(BladeStrategy):
    """Tool angles by key points, as in the paper."""

    name = "blade-keys"
    title = "blade, key points"
    summary = "like blade, but with tool angles through key points and rounded corners"
    curve = "keys"


STRATEGY = BladeKeys()
