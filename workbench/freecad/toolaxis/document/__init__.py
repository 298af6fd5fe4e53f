"""What stands in a document: inputs, operations, plans and machines, read and written; needs no window."""
