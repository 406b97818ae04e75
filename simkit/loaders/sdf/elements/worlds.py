"""Tables of a file, a world and what is in a world only."""

from simkit.loaders.sdf.elements.rows import table

SDF = table(
    "sdf",
    """
@version = the version of the format, 1.0 to 1.12
world    = a world; the first of several is the one that runs > world
model    = the one model of a file without a world > model
light    = the one light of a file without a world > light
actor    ! a file that holds only an actor shows nothing > actor
include  = the one model of a file without a world > include
""",
)

WORLD = table(
    "world",
    """
@name                 = its name
@namespace            - topics are those of the world's name
model                 = a model > model
include               = a model, light or actor from another file > include
light                 = a light > light
frame                 = a frame > frame
joint                 = a joint between models, or to the world > joint
plugin                = a plugin > plugin
physics               = time step and engine > physics
gravity               = gravity [m/s2]
magnetic_field        = magnetic field [T]
gazebo_quirks         = true: sensors err where Gazebo's do (our own; docs/sensors/noise.md)
wind                  = wind
wind/linear_velocity  = its velocity [m/s]
atmosphere            = the air
atmosphere/@type      = adiabatic
atmosphere/temperature = at sea level [K]
atmosphere/temperature_gradient = change with height [K/m]
atmosphere/pressure   = at sea level [Pa]
scene                 = looks
scene/ambient         = ambient light
scene/background      = colour of the background
scene/shadows         = whether lights throw shadows
scene/grid            = whether a grid is drawn
scene/origin_visual   - no axes are drawn at the origin
scene/sky             ~ a sky without clouds and time of day, in place of the background
scene/sky/time        - the sky is that of noon
scene/sky/sunrise     - the sky is that of noon
scene/sky/sunset      - the sky is that of noon
scene/sky/clouds      - the sky has no clouds
scene/sky/cubemap_uri - the sky is our own
scene/fog             = mist
scene/fog/color       = its colour
scene/fog/type        = none, linear, exp or exp2
scene/fog/start       = depth where a linear fog begins [m]
scene/fog/end         = depth from which a linear fog hides all [m]
scene/fog/density     = how fast exp and exp2 thicken [1/m]
scene/quality         = fast, gazebo or high (our own: `<simkit:quality>` for files that Gazebo reads too)
spherical_coordinates = the place on a planet
spherical_coordinates/surface_model = EARTH_WGS84, MOON_SCS or CUSTOM_SURFACE
spherical_coordinates/surface_axis_equatorial = semi-axis of a custom surface [m]
spherical_coordinates/surface_axis_polar = semi-axis of a custom surface [m]
spherical_coordinates/world_frame_orientation = ENU
spherical_coordinates/latitude_deg = latitude of the origin [degrees]
spherical_coordinates/longitude_deg = longitude of the origin [degrees]
spherical_coordinates/elevation = height of the origin [m]
spherical_coordinates/heading_deg = from east to the world's x axis [degrees]
population            = many copies of one model > population
actor                 = a person or animal that follows a script > actor
state                 = what Gazebo Classic saved > state
road                  ! roads are not drawn
gui                   - there is no Gazebo window
audio                 - there is no sound
""",
)

PHYSICS = table(
    "physics",
    """
@name                 = its name, for reports
@type                 - the engine is MuJoCo
@default              = whether it is the profile that counts
max_step_size         = the time step [s]
contact_law           = simkit, or mujoco: the engine's own contacts (our own: `<simkit:contact_law>`; docs/physics.md)
real_time_factor      = how fast it runs when asked to keep pace with the clock
real_time_update_rate = the same in steps a second, where the factor is not given
update_rate           = the same before 1.5
max_contacts          = contacts of one pair of collisions
gravity               = gravity before 1.6 [m/s2]
min_step_size         - the step is fixed
ode                   - another engine's solver
bullet                - another engine's solver
dart                  - another engine's solver
simbody               - another engine's solver
""",
)

POPULATION = table(
    "population",
    """
@name             = its name, which its random places follow from
model             = what is copied > model
model_count       = how many
pose              = the middle of the region, and how it is turned > pose
box               = the region
box/size          = its edges [m]
cylinder          = the region
cylinder/radius   = radius [m]
cylinder/length   = height [m]
distribution      = the rule
distribution/type = random, uniform, grid, linear-x, linear-y or linear-z
distribution/rows = rows of a grid, along y
distribution/cols = columns of a grid, along x
distribution/step = distances in a grid [m]
""",
)

ACTOR = table(
    "actor",
    """
@name                           = its name
pose                            = where it stands > pose
skin                            = what it looks like
person                          = the looks of a person of our own (our own; docs/actors.md)
person/height                   = [m]
person/shirt                    = its colour
person/trousers                 = its colour
person/skin                     = its colour
person/hair                     = its colour
skin/filename                   = mesh with a skeleton
skin/scale                      = its scale
animation                       = motion of the skeleton
animation/@name                 = its name
animation/filename              = its file
animation/scale                 = its scale
animation/interpolate_x         = whether its steps follow the way
script                          = its ways
script/loop                     = whether they begin again
script/delay_start              = wait before them [s]
script/auto_start               = whether they begin by themselves
script/trajectory               = one way
script/trajectory/@id           = its number
script/trajectory/@type         = the animation that plays meanwhile
script/trajectory/tension       = of the spline through its points
script/trajectory/@tension      - an older form of the element
script/trajectory/waypoint      = a point
script/trajectory/waypoint/time = when it is there [s]
script/trajectory/waypoint/pose = where it is > pose
plugin                          = a plugin > plugin
link                            ! links of actors are not simulated
joint                           ! joints of actors are not simulated
static                          - actors never move by physics
""",
)

STATE = table(
    "state",
    """
@world_name           = which world it is of
sim_time              = accepted: time begins at zero
wall_time             = accepted
real_time             = accepted
iterations            = accepted
insertions            = what had come in
insertions/model      = a model > model
insertions/light      = a light > light
insertions/include    = a model from another file > include
deletions             = what had gone
deletions/name        = its name
model                 = a model > saved model
model_state           = a model > saved model
light                 = a light
light/@name           = its name
light/pose            = where it is in the world > pose
light_state           = a light
light_state/@name     = its name
light_state/pose      = where it is in the world > pose
joint_state           ! saved positions of joints are not applied
""",
)

SAVED_MODEL = table(
    "saved model",
    """
@name        = its name
pose         = where it is in the world > pose
scale        ~ other than 1 is reported
link         = a link > saved link
link_state   = a link > saved link
model        = a nested model > saved model
model_state  = a nested model > saved model
joint        ~ reported where links are elsewhere than with joints at zero
joint_state  ~ reported where links are elsewhere than with joints at zero
frame        = accepted
""",
)

SAVED_LINK = table(
    "saved link",
    """
@name           = its name
pose            ~ applied where no joint holds the link; else reported where it differs > pose
velocity        ~ the model starts at rest, which is reported where it moved
acceleration    = accepted: it follows from forces
wrench          = accepted: it is applied anew by whoever applied it
collision       = accepted
collision_state = accepted
""",
)
