"""The parts behind `simkit golden`."""
