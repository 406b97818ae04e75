"""Scores on the command line: of one file, and of all files of a folder."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

from simkit.cli.scores.file_score import FileScore
from simkit.cli.scores.folder_score import FolderScore, with_parts
from simkit.cli.scores.folder_search import find_files
from simkit.cli.scores.isolated_scores import ScoreLimits, score_files
from simkit.cli.scores.score_calculation import EffectOf, ScoreOptions, score_file
from simkit.cli.scores.score_page import write_score_page
from simkit.cli.scores.score_text import folder_lines, score_lines, summary_lines
from simkit.cli.terminal.output import JsonObject, print_json, stdout_console
from simkit.errors import InputError
from simkit.run_fields import LoadArguments
from simkit.sensors.cameras.rendering.render_thread import usable_cores

USUAL_LIMIT: Final = 60.0
"""Wall time for one file of a folder without `--limit` [s]."""
_PICTURE: Final = 1120  # [px] width of the picture of one file
_SMALL_PICTURE: Final = 640  # [px] width of the pictures of a folder
_BAD_EXIT: Final = 2
_MOST_JOBS: Final = 8  # each process needs up to 1.5 GiB


def show_score(
    file: str, arguments: LoadArguments, effect_of: EffectOf, *, html: Path | None, json_: bool, strict: bool
) -> int:
    """Print the score of a file, and write its page; return the exit code."""
    options = ScoreOptions(effect_of, picture=0 if html is None else _PICTURE)
    score = score_file(file, arguments, options)
    if html is not None:
        write_score_page(html, [score])
    if json_:
        _print_json(replace(score, picture="").as_dict())
    else:
        for line in score_lines(score):
            stdout_console().print(line)
    return _BAD_EXIT if _is_bad(score, strict=strict) else 0


def check_folder(
    folder: str,
    arguments: LoadArguments,
    effect_of: EffectOf,
    *,
    run_options: Sequence[str],
    jobs: int | None,
    limit: float | None,
    html: Path | None,
    json_: bool,
    strict: bool,
    every: bool,
) -> int:
    """Print the scores of all files of a folder, and write their page; return the exit code.

    Raises:
        InputError: SK-CLI-062 the folder has no file that can be checked.
    """
    found = find_files(Path(folder))
    if not found.files:
        others = ", ".join(f"{len(files)} × {kind.title}" for kind, files in found.others.items())
        message = f"{folder} has no world, model or robot" + (f"; it has {others}" if others else "")
        raise InputError("SK-CLI-062", message)
    limits = ScoreLimits(jobs or min(usable_cores(), _MOST_JOBS), limit or USUAL_LIMIT)
    options = ScoreOptions(effect_of, details=False, picture=0 if html is None else _SMALL_PICTURE, passes=1)
    paths = [os.path.join(folder, name) for name in found.files]  # noqa: PTH118 - keeps `./` of the argument
    scored = score_files(paths, arguments, options, limits)
    named = [replace(score, file=name) for score, name in zip(scored, found.files, strict=True)]
    table = FolderScore(folder, with_parts(named, Path(folder)), found, run_options)
    if html is not None:
        write_score_page(html, table.files, table)
    if json_:
        _print_json({**table.as_dict(), "files": [replace(score, picture="").as_dict() for score in table.files]})
    else:
        for line in folder_lines(table.files if every else table.whole):
            stdout_console().print(line)
        stdout_console().print()
        for line in summary_lines(table):
            stdout_console().print(line)
    return _BAD_EXIT if any(_is_bad(score, strict=strict) for score in table.whole) else 0


def _is_bad(score: FileScore, *, strict: bool) -> bool:
    """Check whether a file is refused or, if strict, has a warning."""
    return score.status == "refused" or (strict and score.counts.get("warnings", 0) > 0)


def _print_json(value: JsonObject) -> None:
    print_json(value, indent=2)
