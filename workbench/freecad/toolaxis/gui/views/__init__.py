"""How our objects look in the tree and in the 3D view; a panel is imported when a double click opens it."""
