"""Environments for learning: worlds as environments of Gymnasium. `simkit.gym` is the public module."""
