"""Tables of what stands in many places: poses, frames, includes, sensors, plugins."""

from simkit.loaders.sdf.elements.rows import table

POSE = table(
    "pose",
    """
@relative_to     = the frame that it speaks of; without it the default of the element (1.7 and later)
@frame           = the same before 1.7
@degrees         = angles in degrees
@rotation_format = euler_rpy or quat_xyzw
""",
)

FRAME = table(
    "frame",
    """
@name        = its name
@attached_to = the link, joint, frame or model that it moves with
pose         = where it stands > pose
""",
)

INCLUDE = table(
    "include",
    """
@merge              = its content becomes part of the including model or world
uri                 = the file or folder: model://, package://, file://, a path, a Fuel URL that is on this machine
name                = replaces the name of what it brings
pose                = replaces its pose > pose
static              = replaces its <static>
placement_frame     = the frame of the included model that <pose> speaks of
plugin              = one more plugin on what it brings > plugin
experimental:params = adds, modifies, removes or replaces elements of the included model
model_state         - has no effect in Gazebo either
""",
)

SENSOR = table(
    "sensor",
    """
@name          = its name
@type          = its kind; what else stands in it is that kind's own
@gz:type       = the kind of a custom sensor
pose           = where it stands in its link, or for a joint in the joint frame > pose
update_rate    = readings per second of simulated time; 0 is every step
topic          = where it publishes
always_on      = accepted: a sensor that is read is always on
visualize      = accepted: nothing is drawn for it
enable_metrics = accepted: there are no metrics
plugin         = a plugin on the sensor > plugin
""",
    open_=True,
)

PLUGIN = table(
    "plugin",
    """
@name     = its class, or for Gazebo Classic the name of its node
@filename = which plugin it is, together with the name; what stands in it is that plugin's own
""",
    open_=True,
)
