"""Plugins of the pack for motions of arms."""
