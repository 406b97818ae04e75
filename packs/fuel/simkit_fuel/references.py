"""Search for the URLs in a world: in the file itself, and in the models that it includes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from simkit.extend import Diagnostics, Where
from simkit.loaders import Document, Resolver
from simkit.loaders.resources.bundled_models import builtin_model, turtlebot3_uri
from simkit.loaders.resources.fuel_cache import FuelUrl, parse_fuel_url
from simkit.loaders.resources.model_folder import model_file
from simkit.loaders.resources.xml_reader import parse_file
from simkit.writers.vendored_folder import file_elements, file_references

FOREIGN = "SK-FETCH-008"
_SUFFIXES = (".sdf", ".world", ".urdf")
_LOADED = ("include", "mesh", "heightmap", "texture", "image", "skin", "animation", "script")


@dataclass(frozen=True)
class Reference:
    """Fuel URL in a file, with its place."""

    url: FuelUrl
    where: Where


class ReferenceSearch:
    """Search that visits each file once.

    Args:
        resolver: resolver of the URIs.
        diagnostics: receives a warning for each URL that is not one of a Fuel server.
    """

    def __init__(self, resolver: Resolver, diagnostics: Diagnostics) -> None:
        self.resolver, self.diagnostics = resolver, diagnostics
        self._seen: set[Path] = set()

    def of_document(self, document: Document) -> Iterator[Reference]:
        """Yield the Fuel URLs of a file and of the files that it includes from this machine."""
        if document.path is not None:
            self._seen.add(document.path.absolute())
        for element, parent in file_elements(document.root):
            for text in file_references(element, parent):
                if text.startswith(("http://", "https://")):
                    url = parse_fuel_url(text)
                    if url is not None and builtin_model(text) is None:
                        yield Reference(url, element.where)
                    elif url is None and element.name in ("uri", "filename") and parent in _LOADED:
                        message = f"{text:.200} is not the URL of a model or world on a Fuel server; it is not fetched"
                        hint = "download it by hand, and name the file by its path"
                        self.diagnostics.warning(FOREIGN, message, element.where, hint)
                elif parent == "include" and element.name == "uri":
                    yield from self._of_include(turtlebot3_uri(text, element.where, Diagnostics()) or text, document)

    def of_folder(self, folder: Path) -> Iterator[Reference]:
        """Yield the Fuel URLs of a downloaded model or world."""
        for path in sorted(p for p in folder.rglob("*") if p.suffix in _SUFFIXES):
            yield from self._of_file(path)

    def _of_include(self, uri: str, document: Document) -> Iterator[Reference]:
        path, _ = self.resolver.search(uri, document.folder)
        if path is not None and path.is_dir():
            path = model_file(path, Where(str(path)), Diagnostics(), self.resolver.allows)
        if path is not None and path.suffix in _SUFFIXES:
            yield from self._of_file(path)

    def _of_file(self, path: Path) -> Iterator[Reference]:
        """Yield the URLs of one file; a damaged file is reported when it is loaded."""
        if path.absolute() not in self._seen:
            self._seen.add(path.absolute())
            document = parse_file(path, Diagnostics())
            if document is not None:
                yield from self.of_document(document)
