"""A rosbag2 folder: an MCAP file and the `metadata.yaml` that rosbag2 looks for."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

from simkit import msgs
from simkit.sinks.qos import profile
from simkit.sinks.mcap_bag import McapBag

_VERSION = 9  # of the rosbag2 metadata format; the one of ROS 2 Jazzy


class Rosbag2Folder(McapBag):
    """Writes messages to `folder/<name>_0.mcap`; `metadata.yaml` comes with `close()`.

    Raises:
        FileExistsError: the folder exists and may not be replaced, or is no bag.
        OSError: it cannot be written.
    """

    def __init__(self, folder: Path, *, overwrite: bool = False) -> None:
        if folder.exists():
            if not overwrite:
                raise FileExistsError(folder)
            if any(folder.iterdir()) and not (folder / "metadata.yaml").exists() and not list(folder.glob("*.mcap")):
                raise FileExistsError(f"{folder} is not a bag and is left alone")
            shutil.rmtree(folder)
        folder.mkdir(parents=True)
        self.folder = folder
        super().__init__(folder / f"{folder.name}_0.mcap")

    def close(self) -> None:
        """Completes the file and writes the metadata."""
        super().close()
        import yaml

        target = self.folder / "metadata.yaml"
        draft = target.with_suffix(".yaml.tmp")
        draft.write_text(
            yaml.dump({"rosbag2_bagfile_information": self._information()}, Dumper=_plain_dumper(), sort_keys=False)
        )
        draft.replace(target)

    def _information(self) -> dict[str, Any]:
        start = {"nanoseconds_since_epoch": self.span.start}
        duration = {"nanoseconds": self.span.end - self.span.start}
        return {
            "version": _VERSION,
            "storage_identifier": "mcap",
            "duration": duration,
            "starting_time": start,
            "message_count": self.span.count,
            "topics_with_message_count": [
                {
                    "topic_metadata": {
                        "name": channel.topic,
                        "type": channel.type_name,
                        "serialization_format": "cdr",
                        "offered_qos_profiles": [profile(channel.latched)],
                        "type_description_hash": msgs.rihs(channel.type_name),
                    },
                    "message_count": channel.count,
                }
                for channel in self.channels.values()
            ],
            "compression_format": "",
            "compression_mode": "",
            "relative_file_paths": [self.path.name],
            "files": [
                {
                    "path": self.path.name,
                    "starting_time": start,
                    "duration": duration,
                    "message_count": self.span.count,
                }
            ],
            "custom_data": None,
            "ros_distro": "jazzy",
        }


def _plain_dumper() -> Any:
    """A dumper that repeats equal values instead of using anchors."""
    import yaml

    class Plain(yaml.SafeDumper):
        def ignore_aliases(self, data: Any) -> bool:
            return True

    return Plain
