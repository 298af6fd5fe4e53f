"""How our objects look in the tree and in the 3D view; imported only where FreeCAD has its window."""
