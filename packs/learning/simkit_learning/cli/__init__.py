"""Commands of the pack for learning."""
