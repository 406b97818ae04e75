"""Option of `simkit run` that reloads plugins."""
