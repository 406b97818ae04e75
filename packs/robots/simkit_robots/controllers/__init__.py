"""Controllers of Baxter."""
