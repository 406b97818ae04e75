"""Commands of the pack fuel."""
