"""Operations as jobs of FreeCAD's CAM workbench."""
