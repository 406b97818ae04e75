"""Option `--against` of `simkit check`: compare simkit's reading of a robot with that of another program."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Final

from simkit.cli.terminal.options import option, validate_word
from simkit.diagnostics import Diagnostic, Diagnostics
from simkit.errors import InputError
from simkit.install_command import install_command
from simkit.number_text import counted

if TYPE_CHECKING:
    from simkit.cli.second_reader.reading_differences import Difference
    from simkit.cli.second_reader.robot_reading import RobotReading
    from simkit.run_spec import SourceOptions

Against = Annotated[
    str | None,
    option("Compare the reading of a URDF file with that of another program.", "yourdfpy", show_default=False),
]


def _yourdfpy(text: bytes) -> RobotReading:
    from simkit.cli.second_reader.yourdfpy_reader import yourdfpy_reading

    try:
        return yourdfpy_reading(text)
    except ImportError as error:
        message = f"--against yourdfpy needs the package yourdfpy ({error})"
        raise InputError("SK-CLI-059", message, help=install_command("second-reader")) from None


_READERS: Final[Mapping[str, Callable[[bytes], RobotReading]]] = {"yourdfpy": _yourdfpy}


def compare_readers(
    file: str, reader: str, options: SourceOptions, known: Iterable[Diagnostic]
) -> tuple[list[Diagnostic], str]:
    """Return the differences between simkit's reading of a robot and that of another program, and a summary.

    A difference is a note if simkit reports a problem in the same line, because simkit then reads this line as it says.

    Args:
        file: URDF or xacro file, or the bare name of a robot.
        reader: name of the other program.
        options: options for reading the file.
        known: diagnostics of the file.

    Raises:
        InputError: SK-CLI-018 unknown program, SK-CLI-059 the program is not installed, SK-CLI-060 no URDF.
    """
    from simkit.cli.second_reader.reading_differences import reading_differences
    from simkit.cli.second_reader.robot_reading import CONFIGURATIONS, place_of, scene_reading
    from simkit.cli.second_reader.yourdfpy_reader import SecondReaderError
    from simkit.loaders import Resolver, find_document, load_scene
    from simkit.scene.urdf_text import urdf_text

    validate_word("--against", reader, tuple(_READERS))
    resolver = Resolver(
        options.get("resource_paths", ()), missing_meshes=True, package_paths=options.get("package_paths")
    )
    found, xacro_args = Diagnostics(), options.get("xacro_args")
    document, is_expanded = find_document(file, resolver, found, xacro_args)
    if document is not None and document.root.name != "robot":
        message = f"--against compares robots in URDF or xacro; {file} begins with <{document.root.name}>"
        raise InputError("SK-CLI-060", message, help="omit --against for this file")
    model = load_scene(file, resolver=resolver, diagnostics=found, xacro_args=xacro_args).model
    if document is None or model is None or _is_unreadable(found):
        return [], f"{reader}: nothing was compared, because the file has errors"
    ours = scene_reading(model)
    try:
        text = urdf_text(document.root, absolute=False).encode() if is_expanded else document.text
        found_differences = reading_differences(ours, _READERS[reader](text))
    except SecondReaderError as error:
        message = f"{reader} cannot read the file, so nothing was compared: {error}"
        hint = "simkit reads the file; the fault may be in the file or in the other program"
        place = document.root.where
        return [Diagnostic("SK-READER-003", "error", message, place.file, place.line, hint)], ""
    differences = Diagnostics()
    told = {(d.file, d.line): d.code for d in known if d.severity != "error"}
    for difference in found_differences:
        place = place_of(model, difference.part, difference.quantity)
        message = _message(difference, reader)
        if code := told.get((place.file, place.line)):
            differences.note("SK-READER-002", f"{message}; {code} says how simkit reads this line", place)
        else:
            differences.error("SK-READER-001", message, place)
    counts = {kind: sum(part.kind == kind for part in ours.parts) for kind in ("link", "joint", "collision", "visual")}
    listed = ", ".join(_count(count, kind) for kind, count in counts.items())
    summary = (
        f"{reader}: {listed} at {CONFIGURATIONS} sets of joint positions: {_count(len(differences), 'difference')}"
    )
    return list(differences), summary


def _count(number: int, noun: str) -> str:
    return counted(number, noun)


def _message(difference: Difference, reader: str) -> str:
    if difference.quantity == "existence":
        return f"{difference.part} exists only in {'simkit' if difference.found == 'yes' else reader}"
    values = f"{difference.found!r} in simkit, {difference.expected!r} in {reader}"
    return f"{difference.part}: {difference.quantity} is {values}"


def _is_unreadable(found: Diagnostics) -> bool:
    """Check whether a robot has errors in its structure; errors of sensors and plugins change no frames."""
    return any(d.severity == "error" and d.code.startswith(("SK-URDF", "SK-XACRO", "SK-XML", "SK-LOAD")) for d in found)
