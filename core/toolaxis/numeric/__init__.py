"""Mathematics with no word of machining."""
