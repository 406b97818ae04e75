"""A running simulation and those who talk to it from other processes of the same user."""
