"""Skins: faces that continue each other smoothly, machined as one."""
