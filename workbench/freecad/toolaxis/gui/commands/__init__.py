"""The commands, one file each; a panel, which brings numpy and the 3D scene, is imported when a command opens it."""
