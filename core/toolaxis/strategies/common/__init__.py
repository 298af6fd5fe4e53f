"""What strategies with a moving axis share: passes, links, and how they are checked."""
