"""What is machined: surfaces, faces and parts."""
