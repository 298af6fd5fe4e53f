"""The kinds of cutters: one module each; `toolaxis.tools.registry` finds them."""
