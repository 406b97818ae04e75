"""Commands of the pack for authors of plugins and packs."""
