"""Communication between robots by radio and sound."""
