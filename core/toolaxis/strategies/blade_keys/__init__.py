"""Layers around a blade with tool angles by key points; what they are made of stands in `blade`."""
