"""Tables of shapes, visuals, materials and lights."""

from simkit.loaders.sdf.elements.rows import table

VISUAL = table(
    "visual",
    """
@name            = its name
pose             = where it stands in its link > pose
geometry         = its shape > geometry
material         = its colours and texture > material
transparency     = from 0 to 1
cast_shadows     = whether it throws a shadow
visibility_flags = which cameras and lidars see it
laser_retro      = intensity that a lidar reads
plugin           = a plugin on the visual > plugin
meta             - layers of Gazebo's window
""",
)

GEOMETRY = table(
    "geometry",
    """
empty               = no shape
box                 = a box
box/size            = its edges [m]
sphere              = a sphere
sphere/radius       = radius [m]
cylinder            = a cylinder along z
cylinder/radius     = radius [m]
cylinder/length     = length [m]
capsule             = a capsule along z
capsule/radius      = radius [m]
capsule/length      = length of the cylindrical part [m]
cone                = a cone, its tip towards +z
cone/radius         = radius of the base [m]
cone/length         = height [m]
ellipsoid           = an ellipsoid
ellipsoid/radii     = half axes [m]
plane               = a plane: endless for contacts
plane/normal        = its normal
plane/size          = what is drawn of it [m]
mesh                = a mesh: DAE, OBJ, STL, glTF
mesh/uri            = its file
mesh/filename       = its file before 1.4
mesh/scale          = factors along its axes, also negative ones
mesh/submesh        = one part of the file
mesh/submesh/name   = the name of that part
mesh/submesh/center = whether that part is moved to the origin
mesh/@optimization  = how a collision is made of it
mesh/convex_decomposition = how it is split into convex pieces
mesh/convex_decomposition/max_convex_hulls = into how many at most
mesh/convex_decomposition/voxel_resolution - the pieces follow the surface, without voxels
heightmap           = ground from a picture
heightmap/uri       = the picture
heightmap/size      = its width, depth and height [m]
heightmap/pos       = where its middle is
heightmap/texture   - drawn in one colour
heightmap/blend     - drawn in one colour
heightmap/use_terrain_paging - all of it is in memory
heightmap/sampling  - the picture's own pixels count
polyline            = an outline in x and y, extruded along z
polyline/point      = a corner [m]
polyline/height     = its height [m]
image               ! <image> as a shape is not simulated
""",
)

MATERIAL = table(
    "material",
    """
ambient                       = colour under ambient light
diffuse                       = colour
specular                      = colour of the gloss
emissive                      = colour that it gives off by itself
script                        = a name of Gazebo's, or of a .material file
script/#text                  = the name, before 1.2
script/name                   = that name
script/uri                    = where its file is
pbr                           = physically based look
pbr/metal                     = of the metal workflow
pbr/metal/albedo_map          = its texture
pbr/metal/normal_map           - only the albedo is drawn
pbr/metal/roughness_map        - only the albedo is drawn
pbr/metal/metalness_map        - only the albedo is drawn
pbr/metal/environment_map      - only the albedo is drawn
pbr/metal/ambient_occlusion_map - only the albedo is drawn
pbr/metal/emissive_map         - only the albedo is drawn
pbr/metal/light_map            - only the albedo is drawn
pbr/metal/roughness           = how wide its gloss is
pbr/metal/metalness            - only the albedo is drawn
pbr/specular                  = of the specular workflow
pbr/specular/albedo_map       = its texture
pbr/specular/specular_map      - only the albedo is drawn
pbr/specular/glossiness_map    - only the albedo is drawn
pbr/specular/glossiness        - only the albedo is drawn
pbr/specular/environment_map   - only the albedo is drawn
pbr/specular/ambient_occlusion_map - only the albedo is drawn
pbr/specular/normal_map        - only the albedo is drawn
pbr/specular/emissive_map      - only the albedo is drawn
pbr/specular/light_map         - only the albedo is drawn
shader                        - the renderer has one of its own
lighting                      - everything is lit
double_sided                  = whether faces are seen from behind
render_order                  - the depth decides
shininess                     = exponent of the gloss, up to 128
""",
)

LIGHT = table(
    "light",
    """
@name                 = its name
@type                 = point, spot or directional
pose                  = where it stands > pose
direction             = where it shines, in its own frame
diffuse               = colour
specular              = colour of the gloss
intensity             = factor on its colours
attenuation           = how it fades
attenuation/range     ~ how far it shines [m]; it is in the model, but the renderer lets light reach on
attenuation/constant  = constant part
attenuation/linear    = linear part [1/m]
attenuation/quadratic = quadratic part [1/m2]
spot                  = its cone
spot/inner_angle      = full light inside [rad]
spot/outer_angle      = no light outside [rad]
spot/falloff          = how it fades between them
cast_shadows          = whether it throws shadows
light_on              = whether it is on
irradiance            = of a surface facing it [W/m2], a lamp at 1 m, for solar sensors (our own: `<simkit:irradiance>`)
visualize             = accepted: nothing is drawn for it
plugin                - plugins on lights are not run
""",
)
