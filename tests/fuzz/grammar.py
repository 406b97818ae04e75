"""Documents that follow the grammar of real ones, with odd values: which element holds which, learnt from examples."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from xml.sax.saxutils import escape, quoteattr

from hypothesis import strategies as st
from lxml import etree
from mutation import ODD_NAMES, ODD_NUMBERS

DEEPEST = 7
WIDEST = 5


class Grammar:
    """What the elements of some example files hold.

    Args:
        examples: well-formed documents of one format.
        root: name of the outermost element.
    """

    def __init__(self, examples: Iterable[bytes], root: str) -> None:
        self.root = root
        self._children: dict[str, set[str]] = defaultdict(set)
        self._attributes: dict[str, set[str]] = defaultdict(set)
        self._texts: dict[str, set[str]] = defaultdict(set)
        for example in examples:
            self._learn(etree.fromstring(example, etree.XMLParser(recover=True, resolve_entities=False)))

    def _learn(self, element: etree._Element) -> None:
        if not isinstance(element.tag, str) or "}" in element.tag:
            return
        name = element.tag
        for key, value in element.attrib.items():
            if "}" not in str(key):
                self._attributes[name].add(str(key))
                self._texts[f"@{key}"].add(str(value)[:100])
        if element.text and element.text.strip():
            self._texts[name].add(element.text.strip()[:100])
        for child in element:
            if isinstance(child.tag, str) and "}" not in child.tag:
                self._children[name].add(child.tag)
                self._learn(child)

    def documents(self) -> st.SearchStrategy[bytes]:
        """Documents of this grammar."""
        return self._element(self.root, 0).map(lambda text: ('<?xml version="1.0"?>\n' + text).encode())

    @st.composite
    @staticmethod
    def _drawn(draw: st.DrawFn, grammar: Grammar, name: str, depth: int) -> str:
        attributes = "".join(
            f" {key}={quoteattr(draw(grammar._text(f'@{key}')))}"
            for key in sorted(grammar._attributes[name])
            if draw(st.integers(0, 9)) > 0
        )
        inner = ""
        if name in grammar._texts and draw(st.integers(0, 9)) > 0:
            inner += escape(draw(grammar._text(name)))
        kinds = sorted(grammar._children[name])
        if kinds and depth < DEEPEST:
            for kind in draw(st.lists(st.sampled_from(kinds), max_size=WIDEST)):
                inner += draw(grammar._element(kind, depth + 1))
        return f"<{name}{attributes}>{inner}</{name}>\n"

    def _element(self, name: str, depth: int) -> st.SearchStrategy[str]:
        return Grammar._drawn(self, name, depth)

    def _text(self, key: str) -> st.SearchStrategy[str]:
        real = sorted(self._texts[key]) or [""]
        return st.one_of(st.sampled_from(real), st.sampled_from(real), st.sampled_from((*ODD_NUMBERS, *ODD_NAMES)))
