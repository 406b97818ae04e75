"""Codes of what a world runs without: they are in the table of all codes, whose effects the scores of files count."""

from __future__ import annotations

from simkit.cli.diagnostic_catalogue import catalogue
from simkit.testing.run_record.left_out import CODES

AS_IN_GAZEBO = {
    "SK-PLUGIN-010": "a static model does not move with the plugin either",
    "SK-SENSOR-024": "the sensor belongs to another kind of element",
}
"""Codes of parts that Gazebo leaves out too, which cost no points."""


def test_a_score_counts_what_a_world_runs_without_as_left_out() -> None:
    effects = {code: catalogue()[code].effect_of("warning") for code in CODES}
    assert effects == {code: "none" if code in AS_IN_GAZEBO else "left out" for code in CODES}
