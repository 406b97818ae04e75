"""Small robots in URDF for the tests."""

from __future__ import annotations

from simkit.diagnostics import Diagnostic

MASS = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'


def robot(content: str, name: str = "r") -> str:
    return f'<robot name="{name}">{content}</robot>'


def link(name: str, content: str = MASS) -> str:
    return f'<link name="{name}">{content}</link>\n'


def joint(name: str, parent: str, child: str, content: str = LIMIT, kind: str = "revolute") -> str:
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{content}</joint>\n'


def with_code(found: list[Diagnostic], code: str) -> list[Diagnostic]:
    return [d for d in found if d.code == code]


def errors(found: list[Diagnostic]) -> list[str]:
    return [f"{d.code} {d.message}" for d in found if d.severity == "error"]


ARM = robot(link("base") + link("arm") + joint("j", "base", "arm"))
