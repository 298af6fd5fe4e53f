"""Pictures of plans and verdicts."""
