"""Escape text for HTML, and the style sheet of the report page."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from html import escape
from typing import Final

from simkit.diagnostics import shorten

_LONGEST: Final = 2_000
# what XML cannot hold, and the marks that turn the order of letters round, which could make a name read as another
_ILLEGAL: Final = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff\u202a-\u202e\u2066-\u2069\u200e\u200f]"
)


def clean_text(text: str) -> str:
    """A text without what a terminal or a reader would take for more than letters."""
    return _ILLEGAL.sub("\ufffd", text)


def escape_html(text: object) -> str:
    """Any text, for between tags and in attributes; a very long one is cut."""
    return escape(clean_text(shorten(str(text), _LONGEST)), quote=True)


def table(heads: Sequence[str], rows: Iterable[Sequence[str]], marked: Iterable[bool] = ()) -> str:
    """A table that can be moved sideways where it is too wide.

    Args:
        heads: of the columns, as text.
        rows: cells, as markup.
        marked: whether each row stands out.
    """
    marks = list(marked)
    body = ""
    for number, row in enumerate(rows):
        stands_out = ' class="differs"' if number < len(marks) and marks[number] else ""
        body += f"<tr{stands_out}>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>"
    head = "".join(f"<th>{escape_html(name)}</th>" for name in heads)
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


STYLE: Final = """
:root { color-scheme: light dark; --back: #fff; --text: #1c1f24; --faint: #667; --rule: #d5d8de; --card: #f5f6f8;
  --golden: #2166ac; --run: #d95f02; --difference: #b2182b; --good: #1b7837; --bad: #b2182b; --mark: #7a5195; }
@media (prefers-color-scheme: dark) { :root { --back: #15181c; --text: #e4e6ea; --faint: #9aa3b0; --rule: #363c45;
  --card: #1e2227; --golden: #6fb3ff; --run: #ffa24d; --difference: #ff7b84; --good: #6fd08c; --bad: #ff7b84;
  --mark: #c9a0e8; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem; max-width: 72rem; background: var(--back); color: var(--text);
  font: 15px/1.5 system-ui, sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.4rem; margin: .2rem 0; } h2 { font-size: 1.2rem; margin: 0 0 .4rem; }
h3 { font-size: 1rem; margin: 1.2rem 0 .3rem; }
a { color: var(--golden); }
section { border: 1px solid var(--rule); border-left: 5px solid var(--bad); border-radius: 6px; padding: .8rem 1rem;
  margin: 1rem 0; }
section.passed { border-left-color: var(--good); padding: .4rem 1rem; }
.headline { font-size: 1.1rem; font-weight: 600; margin: .2rem 0; }
.badge { border-radius: 4px; padding: .05rem .4rem; font-size: .85rem; border: 1px solid currentColor; }
.good { color: var(--good); } .bad { color: var(--bad); } .small, .faint { color: var(--faint); font-size: .85rem; }
.cause { background: var(--card); border-radius: 6px; padding: .5rem .8rem; margin: .4rem 0; }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: .9rem; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: .25rem .6rem .25rem 0; border-bottom: 1px solid var(--rule);
  min-width: 5rem; }
th { font-weight: 600; color: var(--faint); } tr.differs td { color: var(--bad); }
code, pre { font: .85rem/1.45 ui-monospace, monospace; background: var(--card); border-radius: 4px; }
pre { padding: .6rem; overflow-x: auto; white-space: pre-wrap; } code { padding: .1rem .3rem; }
.grid { display: grid; gap: 1rem; grid-template-columns: repeat(auto-fill, minmax(min(100%, 27rem), 1fr)); }
figure { margin: 0; min-width: 0; } figcaption { font-size: .85rem; margin-bottom: .3rem; }
.key { margin-right: .8rem; white-space: nowrap; } .key::before { content: ""; display: inline-block; width: 1.2em;
  border-top: 3px solid; margin-right: .3em; vertical-align: middle; }
.key.golden { color: var(--golden); } .key.run { color: var(--run); } .key.difference { color: var(--difference); }
.chart { display: block; width: 100%; height: auto; } .chart text { fill: var(--faint); font-size: 11px; }
.chart .middle { text-anchor: middle; } .chart .end { text-anchor: end; }
.chart path { fill: none; } .chart .grid { stroke: var(--rule); stroke-width: .6; display: inline; }
.chart .line { stroke-width: 1.4; stroke-linejoin: round; stroke-linecap: round; }
.chart .golden { stroke: var(--golden); stroke-width: 3; opacity: .6; } .chart .run { stroke: var(--run); }
.chart .difference { stroke: var(--difference); } .chart .mark { stroke: var(--mark); stroke-dasharray: 4 3; }
.pictures { display: flex; gap: .5rem; flex-wrap: wrap; font-size: .8rem; color: var(--faint); }
.pictures div { flex: 1 1 5rem; max-width: 20rem; }
.pictures img { width: 100%; image-rendering: pixelated; border: 1px solid var(--rule); }
@media print { details { display: block; } section { break-inside: avoid-page; } }
"""
