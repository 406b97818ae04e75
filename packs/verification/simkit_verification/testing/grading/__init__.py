"""Grading of a run in two processes: one runs the hand-in and records, the other one judges the recording.

The code of a hand-in runs in the recording process only (`grading_process`), and can change everything there. So this
process computes no verdict: after every step, it streams the values that the checks of the exercise read (poses,
joints, contacts, messages). The process of the judge evaluates the checks from this stream. It imports no file of the
hand-in and decodes only numbers, texts, JSON and CDR, with limits of their sizes.

The judge does not simulate the run again from the hand-in's commands, although a run is deterministic: a plugin may set
joints and forces directly, or be a planner that a server calls, and such a plugin sends no commands that could be sent
again. A hand-in that writes a false recording is hindered, not excluded: `run_stream` describes how.
"""
