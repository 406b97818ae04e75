"""Plugins that move actors, and the models of actors."""
