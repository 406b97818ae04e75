"""Module `importlib` of a program: modules that it imports by name or from a file are the program's own."""

from __future__ import annotations

import importlib as _python
import importlib.util as _util
from importlib.machinery import ModuleSpec, SourceFileLoader
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from simkit_nodes.programs import NodeProgram


def adapt(module: ModuleType, program: NodeProgram) -> None:
    """Let the functions that import use the imports of the program."""

    def import_module(name: str, package: str | None = None) -> ModuleType:
        full = _util.resolve_name(name, package) if name.startswith(".") else name
        result: ModuleType = program.builtins["__import__"](full, {}, {}, ("__name__",), 0)
        return result

    def reload(old: ModuleType) -> ModuleType:
        if old.__name__ in program.replaced:
            return old
        return _python.reload(old)

    def spec_from_file_location(name: str, location: Any = None, **options: Any) -> ModuleSpec | None:
        spec = _util.spec_from_file_location(name, location, **options)
        if spec is not None and type(spec.loader) is SourceFileLoader:
            spec.loader = program.source_loader(name, spec.loader.path)
        return spec

    if module.__name__ == "importlib":
        vars(module).update(import_module=import_module, reload=reload, __import__=program.builtins["__import__"])
    elif module.__name__ == "importlib.util":
        vars(module).update(spec_from_file_location=spec_from_file_location)
    else:
        vars(module).update(SourceFileLoader=program.source_loader)
