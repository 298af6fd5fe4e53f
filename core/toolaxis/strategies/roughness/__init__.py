"""Five axes with a rotary spline for each pass, by strip width and roughness."""
