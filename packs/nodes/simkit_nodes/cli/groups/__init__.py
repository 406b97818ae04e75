"""Commands for groups of other packs."""
