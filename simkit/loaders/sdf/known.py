"""What becomes of the elements that nothing has read: unknown ones are warned about, Gazebo's own are summed up in a note."""

from __future__ import annotations

from collections.abc import Iterator

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.params import Params

_SOLVER = (
    "ode bullet dart simbody solver constraints type max_contacts cfm erp stop_cfm stop_erp suspension provide_feedback "
    "physics min_step_size real_time_update_rate implicit_spring_damper fudge_factor cfm_damping has_friction max_force "
    "split_impulse split_impulse_penetration_threshold poissons_ratio elastic_modulus patch_radius surface_radius "
    "use_patch_radius rolling_friction soft_contact dissipation stiffness must_be_base_link velocity_decay linear angular "
    "minimum_step iters sor precon_iters contact_max_correcting_vel contact_surface_layer allow_auto_disable dt "
    "update_rate fluid_added_mass auto_inertia_params collision_detector island_threads thread_position_correction "
    "use_dynamic_moi_rescaling friction_model min_step friction2 friction_pyramid limit suspension bounce density "
    "velocity bone_stiffness contact erp cfm slip mimic world_frame_orientation surface_model surface_axis_equatorial "
    "surface_axis_polar dynamics radius friction torsional split edge heading_deg convex_decomposition "
    "max_convex_hulls voxel_resolution sampling temperature resolution"
).split()
_PICTURE = (
    "gui audio camera visualize shader normal_map roughness_map metalness_map environment_map ambient_occlusion_map "
    "emissive_map light_map roughness metalness specular_map glossiness_map glossiness pbr metal specular lighting "
    "double_sided render_order shininess uri meta layer fog sky origin_visual clouds sun_enabled time sunrise sunset "
    "texture blend use_terrain_paging sampling size diffuse normal min_height fade_dist visibility_flags "
    "sphericalcoordinates projector particle_emitter laser_retro strip always_on enable_metrics self_collide enable_wind "
    "enable_orientation description author cubemap_uri light_visual audio_source audio_sink atmosphere wind "
    "reference_pressure temperature_gradient pressure plugin allow_auto_disable magnetic state"
).split()
_QUIET = frozenset(_SOLVER + _PICTURE)
_SKIPPED = frozenset(("plugin", "sensor"))
_NOT_SIMULATED = {
    "actor": "actors are not simulated",
    "population": "the models of a population are not created",
    "state": "a saved state is not applied; models stand where their own poses say",
    "road": "roads are not drawn",
    "gripper": "grippers are not simulated; the fingers hold by friction",
    "battery": "batteries are not simulated by the loader",
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
                "SK-SDF-011", f"<{element.name}> is not known here and not used", element.where, did_you_mean(element.name, asked)
            )
    if counts:
        listed = ", ".join(f"<{name}> (line {first[name].line})" for name in sorted(counts, key=lambda n: first[n].line or 0))
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
