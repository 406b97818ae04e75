"""Conversion between `Params` and the document tree that xacro rewrites; every element and copy keeps file and line."""

from __future__ import annotations

from typing import Any
from xml.dom import minidom

from simkit.diagnostics import NOWHERE, Diagnostics, Where
from simkit.params import Params

_KEY = "where"


class _PlaceKeeper:
    """User data handler that copies an element's file and line to its copies."""

    def handle(self, _operation: int, key: str, data: object, _source: object, copy: Any) -> None:
        if copy is not None:
            copy.setUserData(key, data, self)


_KEEP = _PlaceKeeper()


def to_document(root: Params) -> minidom.Document:
    """Return a document tree with file and line of every element."""
    document = minidom.Document()
    top = _element(document, root)
    document.appendChild(top)
    stack = [(root, top)]
    while stack:
        params, node = stack.pop()
        for child in params.children:
            child_node = _element(document, child)
            node.appendChild(child_node)
            stack.append((child, child_node))
    return document


def _element(document: minidom.Document, params: Params) -> minidom.Element:
    node = document.createElement(params.name)
    for name, value in params.attributes.items():
        node.setAttribute(name, value)
    if params.value:
        node.appendChild(document.createTextNode(params.value))
    node.setUserData(_KEY, params.where, _KEEP)
    return node


def place_of(node: minidom.Element | None) -> Where:
    """Return file and line of an element."""
    place = node.getUserData(_KEY) if node is not None else None
    return place if isinstance(place, Where) else NOWHERE


def to_params(top: Any, diagnostics: Diagnostics) -> Params:
    """Convert the tree to `Params`; an element without a known file and line gets those of its parent."""
    root = _params(top, place_of(top), diagnostics)
    stack: list[tuple[minidom.Element, Params]] = [(top, root)]
    while stack:
        node, params = stack.pop()
        for child in node.childNodes:
            if child.nodeType == child.ELEMENT_NODE:
                where = place_of(child)
                child_params = _params(child, params.where if where is NOWHERE else where, diagnostics)
                params.children.append(child_params)
                stack.append((child, child_params))
    return root


def _params(node: minidom.Element, where: Where, diagnostics: Diagnostics) -> Params:
    text = "".join(c.data for c in node.childNodes if c.nodeType in (c.TEXT_NODE, c.CDATA_SECTION_NODE)).strip()
    attributes = {name: str(value) for name, value in node.attributes.items() if not name.startswith("xmlns:xacro")}
    return Params(node.tagName, text, attributes, (), where, diagnostics)
