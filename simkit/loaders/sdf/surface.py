"""Reader of `<surface>`: friction, bounce, contact stiffness and masks."""

from __future__ import annotations

from simkit.params import Params
from simkit.scene import Surface

_TORSION = ("coefficient", "patch_radius", "surface_radius")  # each one of these gives a surface torsional friction


def read_surface(collision: Params) -> Surface:
    """Return the contact properties of a collision; the format's defaults if it has no `<surface>`."""
    block = collision.child("surface")
    if block is None:
        return Surface()
    friction, contact, bounce = block.block("friction"), block.block("contact"), block.block("bounce")
    ode, bullet = friction.block("ode"), friction.block("bullet")
    mu = _friction(ode, "mu", _friction(bullet, "friction", 1.0))
    mu2 = _friction(ode, "mu2", _friction(bullet, "friction2", 1.0 if ode.has("mu") else mu))
    soft = contact.child("ode")
    twist = friction.block("torsional")
    rolling = bullet.number("rolling_friction", 0.0, minimum=0) if bullet.has("rolling_friction") else None
    return Surface(
        mu=mu,
        mu2=mu2,
        fdir1=ode.vector3("fdir1", bullet.vector3("fdir1", (0.0, 0.0, 0.0))),
        slip1=_non_negative(ode, "slip1", 0.0),
        slip2=_non_negative(ode, "slip2", 0.0),
        torsional=twist.number("coefficient", 1.0, minimum=0) if any(map(twist.has, _TORSION)) else None,
        kp=_optional_number(soft, "kp"),
        kd=_optional_number(soft, "kd"),
        soft_cfm=_optional_number(soft, "soft_cfm"),
        soft_erp=_optional_number(soft, "soft_erp"),
        min_depth=_optional_number(soft, "min_depth"),
        max_vel=_optional_number(soft, "max_vel"),
        restitution=bounce.number("restitution_coefficient", 0.0, minimum=0),
        restitution_threshold=bounce.number("threshold", 1e5, finite=False),
        collide_bitmask=_mask(contact, "collide_bitmask"),
        category_bitmask=_mask(contact, "category_bitmask"),
        collide_without_contact=contact.boolean("collide_without_contact", False),
        where=block.where,
        patch_radius=twist.number("patch_radius", 0.0, minimum=0),
        surface_radius=twist.number("surface_radius", 0.0, minimum=0),
        use_patch_radius=twist.boolean("use_patch_radius", True),
        torsional_slip=twist.block("ode").number("slip", 0.0),
        rolling=rolling,
        fdir1_frame=_direction_frame(ode),
    )


def _direction_frame(ode: Params) -> str:
    """Return the link in whose frame `<fdir1>` is given, from Gazebo's own attribute."""
    direction = ode.block("fdir1")
    return direction.attribute("gz:expressed_in") or direction.attribute("ignition:expressed_in")


def _friction(block: Params, name: str, default: float) -> float:
    """Return a friction coefficient; a negative number, which means the default in old files, becomes the default."""
    return _non_negative(block, name, default, finite=False)


def _non_negative(block: Params, name: str, default: float, *, finite: bool = True) -> float:
    """Return a number; a negative one is replaced by the default, with a warning."""
    value = block.number(name, default, finite=finite)
    if value >= 0:
        return value
    message = f"<{name}> is {value:g} and cannot be negative; {default:g} is used"
    block.child_or_self(name).warning("SK-SDF-030", message)
    return default


def _optional_number(block: Params | None, name: str) -> float | None:
    """Return a number, or None if the file gives none."""
    if block is None or not block.has(name):
        return None
    return block.number(name, 0.0, finite=False)


def _mask(contact: Params, name: str) -> int:
    """Return a 16-bit mask, written as decimal or 0x..; all bits are set if the file gives none."""
    mask = contact.child(name)
    if mask is None:
        return 0xFFFF
    text = mask.value.lower()
    try:
        if not text.isascii() or "_" in text:
            raise ValueError
        return int(text, 16 if text.startswith("0x") else 10) & 0xFFFFFFFF
    except ValueError:
        mask.error("SK-PARAM-002", f"found <{name}>{mask.value}</{name}>; expected a whole number")
        return 0xFFFF
