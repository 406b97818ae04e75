"""Commands, options and diagnostic codes of the pack launch."""
