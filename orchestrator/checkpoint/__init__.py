"""Whole-system checkpoints: a run goes on from one as if it had never stopped, to the last bit (docs/decisions/0006-checkpoints.md)."""
