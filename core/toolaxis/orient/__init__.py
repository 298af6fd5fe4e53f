"""Which way to lean: one fixed axis for a face, found and proven free."""
