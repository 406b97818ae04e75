"""Processes that `simkit launch --processes` starts beside the run."""
