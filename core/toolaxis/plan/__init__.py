"""The result as data: what planners fill and everybody else reads."""
