"""Explanation of one moment of a run: contacts, joints, constraints and wheels with their forces and speeds."""
