"""Pack Open-RMF: slotcars, doors and lifts of rmf_simulation, with their messages."""
