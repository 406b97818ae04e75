"""Tables of models, links, their mass and collisions, and joints."""

from simkit.loaders.sdf.elements.rows import table

MODEL = table(
    "model",
    """
@name              = its name
@canonical_link    = the link that the model frame moves with; without it the first one
@placement_frame   = the frame of the model that its pose speaks of
@namespace         - names are scoped by the model's own name
pose               = where it stands > pose
static             = its links do not move
self_collide       = links of the model touch one another
allow_auto_disable = whether it may sleep while it rests
enable_wind        = the wind pushes every link that does not say otherwise
link               = a rigid body > link
joint              = a joint > joint
frame              = a frame > frame
model              = a nested model > model
include            = a model from another file > include
plugin             = a plugin > plugin
gripper            ! grippers are not simulated; the fingers hold by friction
model_state        - has no effect in Gazebo either
""",
)

LINK = table(
    "link",
    """
@name                  = its name
pose                   = where it stands in its model > pose
inertial               = its mass properties > inertial
collision              = a shape that touches > collision
visual                 = a shape that is seen > visual
sensor                 = a sensor > sensor
light                  = a light that moves with it > light
plugin                 = a plugin > plugin
gravity                = whether gravity acts on it
enable_wind            = whether the wind pushes it
self_collide           = it touches the other links of its model
kinematic              = forces do not move it
velocity_decay/linear  = the part of its velocity that is lost at every step
velocity_decay/angular = the same of its angular velocity
velocity_decay         = damping of its motion
must_be_base_link      - every link that no joint holds is a base
audio_sink             - there is no sound
audio_source           - there is no sound
battery                ! a <battery> is not simulated
projector              ! projectors are not simulated
particle_emitter       ! particles are not simulated
""",
)

INERTIAL = table(
    "inertial",
    """
@auto               = mass, centre and inertia are computed from the collisions
mass                = mass [kg]; with auto it scales what is computed
pose                = the centre of mass and the axes of the inertia > pose
density             = of collisions that have none of their own [kg/m3], with auto
inertia             = about the centre of mass [kg m2]
inertia/ixx         = moment
inertia/iyy         = moment
inertia/izz         = moment
inertia/ixy         = product
inertia/ixz         = product
inertia/iyz         = product
auto_inertia_params - meshes are integrated exactly and need no settings
fluid_added_mass    ! the added mass of a fluid is not simulated
""",
)

COLLISION = table(
    "collision",
    """
@name               = its name
pose                = where it stands in its link > pose
geometry            = its shape > geometry
surface             = friction, bounce, stiffness > surface
laser_retro         = intensity that a lidar reads
density             = density [kg/m3], for automatic inertia
auto_inertia_params - meshes are integrated exactly and need no settings
max_contacts        - the engine keeps what it needs
""",
)

SURFACE = table(
    "surface",
    """
friction                                       = friction
friction/ode                                   = sliding friction
friction/ode/mu                                = coefficient along fdir1
friction/ode/mu2                               = coefficient across fdir1
friction/ode/fdir1                             = direction of mu, in the collision frame
friction/ode/fdir1/@gz:expressed_in            = the frame that it is given in
friction/ode/fdir1/@ignition:expressed_in      = as @gz:expressed_in
friction/ode/slip1                             = slip along fdir1
friction/ode/slip2                             = slip across fdir1
friction/bullet                                = stands in where <ode> says nothing
friction/bullet/friction                       = as mu
friction/bullet/friction2                      = as mu2
friction/bullet/fdir1                          = as fdir1
friction/bullet/rolling_friction               = rolling friction
friction/torsional                             = friction against spinning on the spot
friction/torsional/coefficient                 = its coefficient
friction/torsional/use_patch_radius            = whether the patch radius counts, or the surface radius
friction/torsional/patch_radius                = radius of the contact patch [m]
friction/torsional/surface_radius              = radius of the surface [m], of which the patch follows
friction/torsional/ode                         = ODE's own
friction/torsional/ode/slip                    = slip of the torsional friction
bounce                                         = bounce
bounce/restitution_coefficient                 = speed after a hit over the speed before it
bounce/threshold                               ~ kept, but a body bounces at any speed
contact                                        = contact
contact/collide_bitmask                        = which collisions it touches
contact/category_bitmask                       = which category it is of
contact/collide_without_contact                = rays and sensors see it, nothing touches it
contact/collide_without_contact_bitmask        - only the switch above counts
contact/poissons_ratio                         - contacts are not elastic bodies
contact/elastic_modulus                        - contacts are not elastic bodies
contact/ode                                    = stiffness and damping
contact/ode/kp                                 = stiffness [N/m]
contact/ode/kd                                 = damping [N s/m]
contact/ode/soft_cfm                           = softness, an older form of kp and kd
contact/ode/soft_erp                           = error reduction, an older form of kp and kd
contact/ode/min_depth                          = depth from which a contact pushes
contact/ode/max_vel                            = velocity with which it pushes out, at most
contact/bullet                                 - ODE's numbers count
contact/bullet/kp                              - ODE's numbers count
contact/bullet/kd                              - ODE's numbers count
contact/bullet/soft_cfm                        - ODE's numbers count
contact/bullet/soft_erp                        - ODE's numbers count
contact/bullet/split_impulse                   - ODE's numbers count
contact/bullet/split_impulse_penetration_threshold - ODE's numbers count
soft_contact                                   - only rigid contacts are simulated
""",
)

JOINT = table(
    "joint",
    """
@name                         = its name
@type                         = revolute, continuous, prismatic, fixed, ball, universal, revolute2, screw, gearbox
parent                        = the link, or the frame or model whose link, at one end; or world
parent/@link                  = the same before 1.2
child                         = that at the other end
child/@link                   = the same before 1.2
pose                          = the joint frame, in the child's > pose
axis                          = the axis > axis
axis2                         = the second axis of universal, revolute2 and gearbox > axis
thread_pitch                  = of a screw, left-handed [rad/m]
screw_thread_pitch            = of a screw, right-handed [m per turn]; has the last word
gearbox_ratio                 = of a gearbox: angle of the child = -ratio x angle of the parent
gearbox_reference_body        = the link that a gearbox counts its angles from
sensor                        = a sensor on the joint > sensor
plugin                        = a plugin > plugin
physics                       - settings of one engine's solver
""",
)

AXIS = table(
    "axis",
    """
xyz                       = its direction, made a unit vector
xyz/@expressed_in         = the frame that it is given in; without it the joint frame
use_parent_model_frame    = the direction is given in the model frame (before 1.7)
initial_position          - joints start at zero, as in Gazebo
limit                     = limits
limit/lower               = lower limit [rad or m]
limit/upper               = upper limit [rad or m]
limit/effort              = effort that is applied at most [N m or N]; negative is none
limit/velocity            = velocity limit [rad/s or m/s]; negative is none
limit/stiffness           = stiffness of the stop at a limit
limit/dissipation         = damping of the stop at a limit
dynamics                  = friction and spring
dynamics/damping          = viscous friction
dynamics/friction         = dry friction
dynamics/spring_stiffness = spring
dynamics/spring_reference = where the spring is at rest
mimic                     = it follows another joint
mimic/@joint              = the joint that it follows
mimic/@axis               = which axis of that joint
mimic/multiplier          = multiplier
mimic/offset              = offset
mimic/reference           = reference: position = multiplier x (leader - reference) + offset
""",
)
