"""The dialects: one module for each maker of controls, and `registry`, which finds them."""
