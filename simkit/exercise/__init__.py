"""Exercises: a scenario in which a plugin that somebody hands in is to reach something, and what it got for that."""

from __future__ import annotations

from simkit.exercise.exercise import Exercise, Variation, read_exercise
from simkit.exercise.grade import Graded, Marked, Outcome, grade, grade_all

__all__ = ["Exercise", "Graded", "Marked", "Outcome", "Variation", "grade", "grade_all", "read_exercise"]
