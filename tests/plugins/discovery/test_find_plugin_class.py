"""Lookup of a plugin class by a name in a file, and the diagnostics of a failed lookup."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest

from simkit.diagnostics import Diagnostics, Where
from simkit.params import Params
from simkit.plugins import ModelPlugin, Plugin, SensorPlugin, WorldPlugin
from simkit.plugins.discovery.find_plugin_class import find_plugin, plugin_kinds
from simkit.plugins.plugin_names import normalise
from simkit.scene import ScenePlugin

HELLO = """
from simkit.plugins import WorldPlugin

class Hello(WorldPlugin):
    filenames = ("libmy_hello.so",)

    def load(self, parent, params):
        pass
"""


def named(filename: str, name: str = "p") -> ScenePlugin:
    return ScenePlugin(name, filename, "robot", Params("plugin"))


def reported(plugin: ScenePlugin) -> list[tuple[str, str]]:
    return [(d.code, d.severity) for d in plugin.params.diagnostics]


@pytest.mark.parametrize(
    "spelling",
    [
        "gz-sim-diff-drive-system",
        "libgz-sim-diff-drive-system.so",
        "libgz-sim8-diff-drive-system.so",
        "ignition-gazebo-diff-drive-system",
        "libignition-gazebo6-diff-drive-system.so.6",
        "/opt/plugins/libgz-sim-diff-drive-system.so",
    ],
)
def test_all_spellings_of_a_library_are_one_name(spelling: str) -> None:
    assert normalise(spelling) == "gz-sim-diff-drive-system"


def test_the_names_of_classes_lose_ignition_and_versions() -> None:
    assert normalise("ignition::gazebo::systems::DiffDrive") == "gz::sim::systems::DiffDrive"
    assert normalise("gz::sim::v8::systems::DiffDrive") == "gz::sim::systems::DiffDrive"


def test_a_plugin_is_found_by_library_or_by_class_name() -> None:
    by_file = find_plugin(named("libgazebo_ros_diff_drive.so"))
    assert by_file is not None and by_file.__name__ == "GazeboRosDiffDrive"
    by_class = find_plugin(named("libmine.so", "ignition::gazebo::systems::DiffDrive"))
    assert by_class is not None and by_class.__name__ == "DiffDrive"


def test_the_name_attribute_does_not_select_the_class() -> None:
    assert find_plugin(named("libmine.so", "solar_sensor")) is None


def test_every_kind_derives_from_a_base_class_and_has_load() -> None:
    for name, cls in plugin_kinds().items():
        kinds = (cls.parent_kind,) if isinstance(cls.parent_kind, str) else cls.parent_kind
        assert kinds and set(kinds) <= {"world", "model", "visual", "sensor", "any"}, name
        assert name in {normalise(n) for n in (*cls.filenames, *cls.names)}
        assert cls.load is not Plugin.load


def test_the_table_cannot_be_changed() -> None:
    with pytest.raises(TypeError):
        plugin_kinds()["mine"] = WorldPlugin  # type: ignore[index]


def test_an_unknown_plugin_is_a_warning_with_the_closest_known_name() -> None:
    plugin = named("libgazebo_ros_dif_drive.so")
    assert find_plugin(plugin) is None
    (found,) = plugin.params.diagnostics
    assert (found.code, found.severity) == ("SK-PLUGIN-001", "warning")
    assert "libgazebo_ros_dif_drive.so" in found.message
    assert "'libgazebo_ros_diff_drive.so'" in found.hint


def test_the_default_text_of_sdf_is_no_unknown_plugin() -> None:
    plugin = named("__default__", "__default__")
    assert find_plugin(plugin) is None and reported(plugin) == []


def test_a_dissimilar_name_gets_no_other_name() -> None:
    blinker = named("libblinker.so")  # as similar to libgazebo_link_attacher.so as a typing error of four letters
    assert find_plugin(blinker) is None and "did you mean" not in next(iter(blinker.params.diagnostics)).hint
    plugin = named("libgazebo_tutorials.so")
    assert find_plugin(plugin) is None
    (found,) = plugin.params.diagnostics
    assert "libgazebo_tutorials.so" in found.message
    assert found.hint.startswith("`simkit plugin list` shows all names; `simkit plugin new libgazebo_tutorials.so` ")
    assert "`--plugin-path .`" in found.hint


def test_common_ends_of_names_do_not_make_two_plugins_similar() -> None:
    plugin = named("libwobblebot_gazebo_plugin.so")
    assert find_plugin(plugin, parent="world") is None
    (found,) = plugin.params.diagnostics
    assert "did you mean" not in found.hint
    assert "`simkit plugin new libwobblebot_gazebo_plugin.so --on world`" in found.hint


def test_an_unsupported_gazebo_plugin_is_reported_as_such() -> None:
    plugin = named("gz-sim-breadcrumbs-system", "gz::sim::systems::Breadcrumbs")
    assert find_plugin(plugin) is None
    assert reported(plugin) == [("SK-PLUGIN-002", "warning")]


def test_an_unsupported_plugin_that_only_changes_pictures_is_a_note() -> None:
    plugin = named("gz-sim-lens-flare-system", "gz::sim::systems::LensFlare")
    assert find_plugin(plugin) is None
    assert reported(plugin) == [("SK-PLUGIN-002", "note")]


def test_the_plugins_of_one_family_are_reported_once() -> None:
    found = Diagnostics()
    for name in ("controlboard", "controlboard", "imu", "forcetorque"):
        assert find_plugin(named(f"libgazebo_yarp_{name}.so"), diagnostics=found) is None
    (warning,) = found
    assert "gz-sim-joint-position-controller-system" in warning.message


def test_a_plugin_on_the_wrong_kind_of_parent_is_ignored_with_the_right_kind() -> None:
    plugin = named("gz-sim-diff-drive-system")
    assert find_plugin(plugin, parent="world") is None
    (found,) = plugin.params.diagnostics
    assert (found.code, found.severity) == ("SK-PLUGIN-007", "warning")
    assert "is ignored: it is for a model, but is attached to a" in found.message
    assert find_plugin(named("gz-sim-diff-drive-system"), parent="model") is not None


# ------------------------------------------------------------------ a user's own Python


def test_a_file_runs_only_from_an_allowed_folder(tmp_path: Path) -> None:
    (tmp_path / "hello.py").write_text(HELLO)
    refused = named("hello.py")
    assert find_plugin(refused) is None
    assert reported(refused) == [("SK-PLUGIN-001", "error")]
    found = find_plugin(named("hello.py"), [tmp_path])
    assert found is not None and found.__name__ == "Hello"


def test_a_module_of_python_is_no_folder_to_allow() -> None:
    refused = named("json:Nope")
    assert find_plugin(refused) is None
    (found,) = refused.params.diagnostics
    assert "allow the folder of the file with --plugin-path DIR" in found.hint


def test_a_file_cannot_climb_out_of_the_allowed_folder(tmp_path: Path) -> None:
    (tmp_path / "allowed").mkdir()
    (tmp_path / "outside.py").write_text("raise SystemExit('was run')")
    assert find_plugin(named("../outside.py"), [tmp_path / "allowed"]) is None
    assert find_plugin(named(str(tmp_path / "outside.py")), [tmp_path / "allowed"]) is None


def test_a_link_out_of_the_allowed_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "allowed").mkdir()
    (tmp_path / "outside.py").write_text("raise SystemExit('was run')")
    (tmp_path / "allowed" / "inside.py").symlink_to(tmp_path / "outside.py")
    assert find_plugin(named("inside.py"), [tmp_path / "allowed"]) is None
    assert find_plugin(named("libwas.so"), [tmp_path / "allowed"]) is None


def test_a_module_and_class_run_only_from_an_allowed_folder(tmp_path: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "hello.py").write_text(HELLO)
    refused = named("mine.hello:Hello")
    assert find_plugin(refused) is None
    assert reported(refused) == [("SK-PLUGIN-001", "error")]
    found = find_plugin(named("mine.hello:Hello"), [tmp_path])
    assert found is not None and found.__name__ == "Hello"


def test_a_file_may_name_its_class(tmp_path: Path) -> None:
    (tmp_path / "two-plugins.py").write_text(HELLO + HELLO.replace("Hello", "Goodbye"))
    for name in ("Hello", "Goodbye"):
        found = find_plugin(named(f"two-plugins.py:{name}"), [tmp_path])
        assert found is not None and found.__name__ == name


@pytest.mark.parametrize("filename", ["hello.py:Helo", "hello:Helo"])
def test_a_misspelled_class_is_an_error_with_the_closest_class_of_the_file(tmp_path: Path, filename: str) -> None:
    (tmp_path / "hello.py").write_text(HELLO)
    plugin = named(filename)
    assert find_plugin(plugin, [tmp_path]) is None
    (found,) = plugin.params.diagnostics
    assert (found.code, found.severity, found.hint) == ("SK-PLUGIN-008", "error", "did you mean 'Hello'?")


def test_a_missing_file_names_the_folder_to_allow(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "worlds").mkdir()
    (tmp_path / "worlds" / "hello.py").write_text(HELLO)
    monkeypatch.chdir(tmp_path)
    for filename in ("hello.py", "hello.py:Hello", "hello:Hello"):
        plugin = named(filename)
        plugin = replace(plugin, where=Where(str(tmp_path / "worlds" / "w.sdf"), 3))
        assert find_plugin(plugin) is None
        (found,) = plugin.params.diagnostics
        assert (found.code, found.severity, found.line) == ("SK-PLUGIN-001", "error", 3)
        assert "`--plugin-path worlds`" in found.hint and "plugin_paths=['worlds']" in found.hint


def test_a_misspelled_file_is_an_error_with_the_closest_file(tmp_path: Path) -> None:
    (tmp_path / "hello.py").write_text(HELLO)
    plugin = named("helo.py")
    assert find_plugin(plugin, [tmp_path]) is None
    (found,) = plugin.params.diagnostics
    assert (found.severity, found.hint) == ("error", "did you mean 'hello.py'?")


@pytest.mark.parametrize("filename", ["libmine.so:Class", "gz::sim::systems::Mine", "mine", "libmine.so"])
def test_a_name_that_is_not_python_stays_a_warning(filename: str) -> None:
    plugin = named(filename)
    assert find_plugin(plugin) is None
    assert reported(plugin) == [("SK-PLUGIN-001", "warning")]


def test_an_importable_module_named_by_a_file_is_not_run() -> None:
    plugin = named("antigravity:Plugin")
    assert find_plugin(plugin) is None
    assert reported(plugin) == [("SK-PLUGIN-001", "error")]


def test_an_alias_is_found_in_allowed_folders(tmp_path: Path) -> None:
    (tmp_path / "hello.py").write_text(HELLO)
    (tmp_path / "other.py").write_text("raise SystemExit('was run')")
    found = find_plugin(named("libmy_hello.so"), [tmp_path])
    assert found is not None and found.__name__ == "Hello"


def test_a_module_that_raises_on_import_is_an_error_with_its_reason(tmp_path: Path) -> None:
    (tmp_path / "broken.py").write_text("1 / 0")
    plugin = named("broken.py")
    assert find_plugin(plugin, [tmp_path]) is None
    (found,) = plugin.params.diagnostics
    assert (found.code, found.severity) == ("SK-PLUGIN-008", "error")
    assert "ZeroDivisionError" in found.message


def test_a_class_that_is_not_a_plugin_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text("class Thing: pass")
    plugin = named("mine:Thing")
    assert find_plugin(plugin, [tmp_path]) is None
    assert reported(plugin) == [("SK-PLUGIN-008", "error")]


# ------------------------------------------------------------------ the base class


def test_a_hook_that_is_not_overridden_does_not_count() -> None:
    class Reader(ModelPlugin):
        def load(self, parent: object, params: Params) -> None: ...
        def after_step(self) -> None: ...

    assert Reader.has_hook("after_step")
    assert not any(Reader.has_hook(hook) for hook in ("before_step", "prepare", "reset", "close"))


def test_a_plugin_needs_a_load_method() -> None:
    with pytest.raises(TypeError, match="load"):
        SensorPlugin()  # type: ignore[abstract]


def test_a_plugin_imports_the_modules_of_its_own_folder(tmp_path: Path) -> None:
    """Two folders may have modules of the same name."""
    sizes = []
    for size in (1, 2):
        folder = tmp_path / str(size)
        folder.mkdir()
        (folder / "helper_of_a_plugin.py").write_text(f"SIZE = {size}\n")
        (folder / "hello.py").write_text("from helper_of_a_plugin import SIZE\n" + HELLO + "    size = SIZE\n")
        found = find_plugin(named("hello.py"), [folder])
        sizes.append(found.size)  # type: ignore[union-attr]
        assert "helper_of_a_plugin" not in sys.modules and str(folder) not in sys.path
    assert sizes == [1, 2]
