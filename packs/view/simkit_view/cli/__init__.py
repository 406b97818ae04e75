"""Commands of the pack view."""
