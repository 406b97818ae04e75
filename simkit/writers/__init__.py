"""Scenes back into files."""
