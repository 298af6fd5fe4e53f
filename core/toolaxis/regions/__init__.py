"""Tool, axis and region chosen together: which cells of a face which tool cuts under which axis, and how fast."""
