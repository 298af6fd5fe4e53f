"""The strategy `blade-keys`: as `blade`, with tool angles by key points and rounded corners."""

from toolaxis.strategies.blade.strategy import Blade


class BladeKeys(Blade):
    """Tool angles by key points, as in the paper."""

    name = "blade-keys"
    title = "blade, key points"
    summary = "as blade, with tool angles by key points and rounded corners"
    curve = "keys"


STRATEGY = BladeKeys()
