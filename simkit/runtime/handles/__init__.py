"""Handles of the entities of a simulation: Model, Link, Joint, Light, Visual."""
