"""Options that the commands which draw share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Output = Annotated[
    Path, typer.Option("--output", "-o", help="The file: .svg or .png.", metavar="OUT", show_default=True)
]
Against = Annotated[
    str | None, typer.Option(help="Draws over this field in place of time.", metavar="FIELD", show_default=False)
]
Start = Annotated[float | None, typer.Option("--start", help="Leaves out what was before.", metavar="S")]
End = Annotated[float | None, typer.Option("--end", help="Leaves out what was after.", metavar="S")]
Title = Annotated[str, typer.Option(help="Above the chart.", metavar="TEXT", show_default=False)]
