"""Pack with losses and errors of real sensors."""
