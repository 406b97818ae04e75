"""Commands and options of the pack."""
