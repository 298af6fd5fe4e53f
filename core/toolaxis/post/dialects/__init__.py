"""The dialects: one module for each maker of controls, and `known` with all of them."""
