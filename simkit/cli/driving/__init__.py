"""A driver at the keyboard."""
