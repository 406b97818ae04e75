"""What the commands share that talk to a running simulation or read a bag."""
