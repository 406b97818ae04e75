"""What every world brings: its clock, its services, its statistics."""
