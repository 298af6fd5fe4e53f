"""FreeCAD's own Open CASCADE: documents and shapes in."""
