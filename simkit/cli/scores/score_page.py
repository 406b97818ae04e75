"""Scores as one HTML page that loads no other files and runs no code."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.cli.scores.file_score import FileScore
from simkit.cli.scores.folder_score import FolderScore
from simkit.cli.scores.part_list import KIND_TITLES
from simkit.cli.scores.score_text import MISSING_TITLES, place_text, row_text, status_text
from simkit.diagnostics import shorten
from simkit.testing.golden.report.text_report import clean_text
from simkit.writers.atomic_output import write_atomically

if TYPE_CHECKING:
    from jinja2 import Template

_BASE64: Final = re.compile("[A-Za-z0-9+/]*={0,2}")
_TEMPLATE: Final = Path(__file__).with_name("score_page.html.j2")
_LONGEST: Final = 1000  # characters of a text
_ROWS: Final = 500  # rows of a table


def write_score_page(path: Path, scores: Sequence[FileScore], table: FolderScore | None = None) -> None:
    """Write the page of one file, or of the files of a folder, atomically.

    Args:
        path: file to write.
        scores: scores of the files.
        table: table of the folder; None for one file.

    Raises:
        InputError: SK-CLI-016 the file cannot be written.
    """
    write_atomically(path, score_page(scores, table).encode())


def score_page(scores: Sequence[FileScore], table: FolderScore | None = None) -> str:
    """Return the page as HTML text that is valid XML too."""
    title = table.folder if table is not None else scores[0].file
    return _template().render(title=title, scores=scores, table=table)


def _template() -> Template:
    from jinja2 import Environment, StrictUndefined  # slow to import, and only pages need it
    from markupsafe import Markup

    def clean(value: object) -> object:
        return value if isinstance(value, Markup) else clean_text(shorten(str(value), _LONGEST))

    def image(data: str) -> Markup:
        """Return the address of a picture, which a child process has sent."""
        return Markup("data:image/jpeg;base64," + (data if _BASE64.fullmatch(data) else ""))

    environment = Environment(
        autoescape=True, finalize=clean, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters.update(status=status_text, row=row_text)
    environment.globals.update(
        most_rows=_ROWS, missing_titles=MISSING_TITLES, titles=KIND_TITLES, place=place_text, image=image
    )
    return environment.from_string(_TEMPLATE.read_text(encoding="utf-8"))
