"""Commands of the pack verification."""
