"""Short inputs for examples: what an example is not about is written once, here."""

from __future__ import annotations

from collections.abc import Mapping
from textwrap import dedent, indent

from simkit.codes import Example

Files = Mapping[str, str | bytes]

INERTIAL = "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"


def sdf(content: str, version: str = "1.9", files: Files | None = None) -> Example:
    """A file with `content` inside its `<sdf>`."""
    return Example(f'<sdf version="{version}">\n{_inner(content)}\n</sdf>\n', files=files or {})


def world(content: str, version: str = "1.9", files: Files | None = None) -> Example:
    """A world with `content`."""
    return sdf(f'<world name="default">\n{_inner(content)}\n</world>', version, files)


def model(content: str, version: str = "1.9", files: Files | None = None) -> Example:
    """A bare model with `content`."""
    return sdf(f'<model name="robot">\n{_inner(content)}\n</model>', version, files)


def link(content: str, version: str = "1.9", files: Files | None = None) -> Example:
    """A bare model whose one link, of 1 kg, has `content`."""
    return model(f'<link name="base">\n  {INERTIAL}\n{_inner(content)}\n</link>', version, files)


def static(content: str, version: str = "1.9", files: Files | None = None) -> Example:
    """A static model whose one link has `content`."""
    return model(f'<static>true</static>\n<link name="base">\n{_inner(content)}\n</link>', version, files)


def joint(content: str, kind: str = "revolute", version: str = "1.9") -> Example:
    """A base and an arm with one joint, which has `content` beside its parent and child."""
    return model(
        f'<link name="base">{INERTIAL}</link>\n<link name="arm">{INERTIAL}</link>\n'
        f'<joint name="elbow" type="{kind}">\n  <parent>base</parent><child>arm</child>\n{_inner(content)}\n</joint>',
        version,
    )


def shape(geometry: str, files: Files | None = None) -> Example:
    """A link whose collision has that `<geometry>`."""
    return link(f'<collision name="hull"><geometry>{geometry}</geometry></collision>', files=files)


def surface(content: str) -> Example:
    """A link whose collision, a box of 1 m, has that `<surface>`."""
    return link(
        '<collision name="hull">\n  <geometry><box><size>1 1 1</size></box></geometry>\n'
        f"  <surface>{content}</surface>\n</collision>"
    )


def sensor(kind: str, content: str) -> Example:
    """A link with one sensor."""
    return link(f'<sensor name="eye" type="{kind}">\n{_inner(content)}\n</sensor>')


def python(text: str, files: Files | None = None) -> Example:
    """A script."""
    return Example(dedent(text).strip() + "\n", "python", files or {})


def command(text: str, files: Files | None = None) -> Example:
    """A line for the shell."""
    return Example(text, "command", files or {})


def _inner(content: str) -> str:
    return indent(dedent(content).strip("\n"), "  ")


BALL = sdf(
    f"""
<model name="ball">
  <pose>0 0 1 0 0 0</pose>
  <link name="body">
    {INERTIAL}
    <collision name="hull"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
  </link>
</model>
"""
).text
"""A file with a ball, for commands and scripts."""
