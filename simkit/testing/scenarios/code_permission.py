"""Permission for the code that a scenario, golden run, exercise or sweep asks for.

Readers store the requests in `RunSpec.code_requests`. `RunSpec.load_arguments` refuses to load a world as long as there
are any, so that a caller who forgets the permission runs no code.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import cast

from simkit.code_requests import CodeRequest, code_refusal
from simkit.facade import pack_module
from simkit.run_spec import FilePath, LoadOptions, RunSpec


def permit_code(spec: RunSpec, allow_code: bool = False, plugin_paths: Sequence[FilePath] = ()) -> RunSpec:
    """Return a specification whose plugin folders are allowed.

    Args:
        spec: specification with the requests of its file.
        allow_code: allow all of them.
        plugin_paths: folders of code that the user allows; they allow requests for them and for folders in them.

    Raises:
        LoadError: SK-SCEN-008 the file asks for other code.
    """
    if spec.launch:
        return _launched_run(spec, allow_code, plugin_paths)
    if not spec.code_requests:
        return spec
    check_requests(spec.code_requests, allow_code, plugin_paths)
    options = dict(spec.options)
    if folders := [request.path for request in spec.code_requests if request.is_folder and request.path is not None]:
        options["plugin_paths"] = (*spec.options.get("plugin_paths", ()), *folders)
    return replace(spec, options=cast(LoadOptions, options), code_requests=())


def _launched_run(spec: RunSpec, allow_code: bool, plugin_paths: Sequence[FilePath]) -> RunSpec:
    """Return a specification with what its launch file starts, if the user allows its code and that of its nodes."""
    check_requests(spec.code_requests, allow_code, plugin_paths)
    launched: RunSpec = pack_module("simkit.launch").launched_run(replace(spec, code_requests=()))
    requests = (*(each for each in spec.code_requests if each.is_folder), *launched.code_requests)
    return permit_code(replace(launched, code_requests=requests), allow_code, plugin_paths)


def check_requests(
    requests: Sequence[CodeRequest], allow_code: bool = False, plugin_paths: Sequence[FilePath] = ()
) -> None:
    """Check that the user allows all code that a file asks for.

    Raises:
        LoadError: SK-SCEN-008 the user does not.
    """
    refused = [] if allow_code else [request for request in requests if not request.is_within(plugin_paths)]
    if refused:
        raise code_refusal(refused)


def add_options(spec: RunSpec, options: LoadOptions, allow_code: bool = False) -> RunSpec:
    """Return a specification with further load options of the user, whose plugin folders also are a permission.

    Raises:
        LoadError: SK-SCEN-008 the file asks for code that the user does not allow.
    """
    added = without_permissions(spec, options)
    permitted = permit_code(spec, allow_code, options.get("plugin_paths", ()))
    merged = {**permitted.options, **added}
    if "plugin_paths" in added:
        merged["plugin_paths"] = (*added["plugin_paths"], *permitted.options.get("plugin_paths", ()))
    return replace(permitted, options=cast(LoadOptions, merged))


def without_permissions(spec: RunSpec, options: LoadOptions) -> LoadOptions:
    """Return load options without the plugin folders that only allow requests of a file."""
    folders = options.get("plugin_paths", ())
    added = [folder for folder in folders if not any(request.is_within([folder]) for request in spec.code_requests)]
    if len(added) == len(folders):
        return options
    others = {name: value for name, value in options.items() if name != "plugin_paths"}
    return cast(LoadOptions, {**others, "plugin_paths": tuple(added)} if added else others)
