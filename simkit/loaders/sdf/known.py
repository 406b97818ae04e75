"""Elements that nothing has read: unknown ones are warned about, Gazebo's own settings are summed up in a note."""

from __future__ import annotations

from collections.abc import Iterator

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.params import Params

_QUIET_WORDS = """
ode bullet dart simbody physics real_time_update_rate min_step_size max_contacts provide_feedback allow_auto_disable
velocity_decay must_be_base_link enable_wind auto_inertia_params thread_position_correction rolling_friction
patch_radius surface_radius use_patch_radius soft_contact poissons_ratio elastic_modulus dissipation stiffness
convex_decomposition sampling collide_without_contact_bitmask
gui audio audio_sink audio_source visualize meta layer lighting double_sided render_order shininess shader normal_map
roughness_map metalness_map environment_map ambient_occlusion_map emissive_map light_map roughness metalness
specular_map glossiness_map glossiness fog sky origin_visual texture blend use_terrain_paging cubemap_uri
surface_axis_equatorial surface_axis_polar atmosphere wind
"""
# Engines and their solvers; pictures, sound and windows; the air, for the plugins that ask.
_QUIET = frozenset(_QUIET_WORDS.split())
_SKIPPED = frozenset(("plugin", "sensor"))
_NOT_SIMULATED = {
    "actor": "actors are not simulated",
    "population": "the models of a population are not created",
    "state": "a saved state is not applied; models stand where their own poses say",
    "road": "roads are not drawn",
    "gripper": "grippers are not simulated; the fingers hold by friction",
    "battery": "a <battery> is not simulated",
    "urdf": "a URDF inside SDF is not read",
    "particle_emitter": "particles are not simulated",
    "projector": "projectors are not simulated",
    "fluid_added_mass": "the added mass of a fluid is not simulated",
}


def report_unread(root: Params, diagnostics: Diagnostics) -> None:
    """Says what in a file has no effect: a warning for each unknown element, one note for Gazebo's own settings."""
    counts: dict[str, int] = {}
    first: dict[str, Where] = {}
    for element, asked in _unread(root):
        if element.name in _NOT_SIMULATED:
            diagnostics.warning("SK-SDF-012", f"<{element.name}>: {_NOT_SIMULATED[element.name]}", element.where)
        elif element.name in _QUIET:
            counts[element.name] = counts.get(element.name, 0) + 1
            first.setdefault(element.name, element.where)
        else:
            diagnostics.warning(
                "SK-SDF-011",
                f"<{element.name}> is not known here and not used",
                element.where,
                did_you_mean(element.name, asked),
            )
    if counts:
        listed = ", ".join(
            f"<{name}> (line {first[name].line})" for name in sorted(counts, key=lambda n: first[n].line or 0)
        )
        where = min(first.values(), key=lambda w: w.line or 0)
        diagnostics.note("SK-SDF-010", f"settings of Gazebo's without effect here: {listed}", Where(where.file))


def _unread(element: Params) -> Iterator[tuple[Params, set[str]]]:
    for child in element.children:
        if ":" in child.name or child.name in _SKIPPED:
            continue
        if child.was_read:
            yield from _unread(child)
        else:
            yield child, element.asked
