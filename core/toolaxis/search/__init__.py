"""The fixed axis that machines a face in the least time, found and proven free."""
