"""List of the files that an MJCF file needs, for a copy that keeps their relative positions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from simkit.diagnostics import Diagnostics
from simkit.loaders import Document, Resolver
from simkit.loaders.resources.uris import absolute_path
from simkit.loaders.resources.xml_reader import parse_file
from simkit.params import Params

_FOLDERS = ("assetdir", "meshdir", "texturedir")


def mjcf_files(root: Params, folder: Path, resolver: Resolver) -> dict[Path, Document | None]:
    """Return the readable files of an MJCF file, with the documents of those that are included or attached.

    An included file can use the asset folders of the file that includes it, and the other way round. So every name is
    tried in every folder.

    Args:
        root: outermost element of the file.
        folder: folder of the file.
        resolver: finds only files that may be read.
    """
    roots, bases = [root], [folder]
    files: dict[Path, Document | None] = {}
    inside: dict[str, None] = {"": None}
    for section in roots:  # the loop also visits the roots that it adds
        for compiler in section.all("compiler"):
            inside |= dict.fromkeys(value for key, value in compiler.attributes.items() if key in _FOLDERS)
        for source in _named_files(section, bases, ("",), resolver):
            document = parse_file(source, Diagnostics()) if source.suffix == ".xml" else None
            if document is not None and source not in files:
                files[source] = document
                roots.append(document.root)
                bases += [source.parent] if source.parent not in bases else []
    for section in roots:
        for source in _named_files(section, bases, inside, resolver):
            files.setdefault(source, None)
    return files


def _named_files(root: Params, bases: Iterable[Path], inside: Iterable[str], resolver: Resolver) -> Iterator[Path]:
    """Yield the readable files that the attributes `file`, `fileup` and so on can name."""
    names: dict[str, None] = {}
    elements = [root]
    while elements:
        element = elements.pop()
        names |= dict.fromkeys(value for key, value in element.attributes.items() if key.startswith("file"))
        elements += reversed(element.children)
    places = [base / part for base in bases for part in inside]
    for source in (absolute_path(place / name) for name in names for place in places):
        if source.is_file() and resolver.search(str(source), places[0])[0] == source:
            yield source
