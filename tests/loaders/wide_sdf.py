"""SDF files that contain every element and attribute that a reader reads, each at least once."""

POSE = '<pose relative_to="" degrees="true" rotation_format="euler_rpy">0 0 0 0 0 0</pose>'
PLUGIN = '<plugin name="p" filename="libp.so"><anything/></plugin>'
SURFACE = """<surface>
  <friction><ode><mu>1</mu><mu2>1</mu2><fdir1>1 0 0</fdir1><slip1>0</slip1><slip2>0</slip2></ode>
    <bullet><friction>1</friction><friction2>1</friction2><fdir1>1 0 0</fdir1><rolling_friction>0.1</rolling_friction>
    </bullet><torsional><coefficient>1</coefficient><use_patch_radius>true</use_patch_radius>
    <patch_radius>0.1</patch_radius><surface_radius>0.1</surface_radius><ode><slip>0</slip></ode></torsional></friction>
  <bounce><restitution_coefficient>0.1</restitution_coefficient><threshold>1</threshold></bounce>
  <contact><collide_bitmask>1</collide_bitmask><category_bitmask>1</category_bitmask>
    <collide_without_contact>false</collide_without_contact>
    <ode><kp>1e5</kp><kd>1</kd><soft_cfm>0</soft_cfm><soft_erp>0.2</soft_erp><min_depth>0</min_depth>
      <max_vel>0.1</max_vel></ode></contact></surface>"""
MATERIAL = """<material><ambient>1 1 1 1</ambient><diffuse>1 1 1 1</diffuse><specular>1 1 1 1</specular>
  <emissive>0 0 0 1</emissive><script><name>Gazebo/Red</name><uri>file://x</uri></script>
  <pbr><metal><albedo_map>a.png</albedo_map></metal><specular><albedo_map>a.png</albedo_map></specular></pbr>
  </material>"""
SHAPES = (
    "<empty/>",
    "<box><size>1 1 1</size></box>",
    "<sphere><radius>1</radius></sphere>",
    "<cylinder><radius>1</radius><length>1</length></cylinder>",
    "<capsule><radius>1</radius><length>1</length></capsule>",
    "<cone><radius>1</radius><length>1</length></cone>",
    "<ellipsoid><radii>1 1 1</radii></ellipsoid>",
    "<plane><normal>0 0 1</normal><size>1 1</size></plane>",
    '<mesh optimization=""><uri>a.obj</uri><filename>a.obj</filename><scale>1 1 1</scale>'
    "<submesh><name>x</name><center>false</center></submesh>"
    "<convex_decomposition><max_convex_hulls>4</max_convex_hulls></convex_decomposition></mesh>",
    "<heightmap><uri>a.png</uri><size>1 1 1</size><pos>0 0 0</pos></heightmap>",
    "<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>1</height></polyline>",
)
LIGHT = f"""<light name="LAMP" type="spot">{POSE}<direction>0 0 -1</direction><diffuse>1 1 1 1</diffuse>
  <specular>1 1 1 1</specular><intensity>1</intensity><attenuation><range>1</range><constant>1</constant>
  <linear>0</linear><quadratic>0</quadratic></attenuation><spot><inner_angle>0.1</inner_angle>
  <outer_angle>0.2</outer_angle><falloff>1</falloff></spot><cast_shadows>true</cast_shadows><light_on>true</light_on>
  <visualize>false</visualize></light>"""
SENSOR = f"""<sensor name="SENSOR" type="custom" gz:type="odd">{POSE}<update_rate>1</update_rate><topic>t</topic>
  <always_on>1</always_on><visualize>0</visualize><enable_metrics>0</enable_metrics>{PLUGIN}</sensor>"""
AXIS = """<xyz expressed_in="">0 0 1</xyz><limit><lower>-1</lower><upper>1</upper><effort>1</effort>
  <velocity>1</velocity><stiffness>1e8</stiffness><dissipation>1</dissipation></limit>
  <dynamics><damping>1</damping><friction>1</friction><spring_stiffness>1</spring_stiffness>
  <spring_reference>0</spring_reference></dynamics><mimic joint="{leader}" axis="axis"><multiplier>1</multiplier>
  <offset>0</offset><reference>0</reference></mimic>"""


def joint(name: str, kind: str, inside: str = "", leader: str = "leader") -> str:
    axis = AXIS.replace("{leader}", leader)
    return (
        f'<joint name="{name}" type="{kind}"><parent>a</parent><child>b</child>{POSE}'
        f"<axis>{axis}</axis><axis2>{axis}</axis2>{inside}</joint>"
    )


def _visuals() -> str:
    return "".join(
        f'<visual name="v{i}">{POSE}<geometry>{shape}</geometry>{MATERIAL}<transparency>0</transparency>'
        f"<cast_shadows>1</cast_shadows><visibility_flags>1</visibility_flags><laser_retro>0</laser_retro>{PLUGIN}"
        "</visual>"
        for i, shape in enumerate(SHAPES)
    )


def _collisions() -> str:
    return (
        f'<collision name="c">{POSE}<geometry>{SHAPES[1]}</geometry>{SURFACE}<laser_retro>0</laser_retro>'
        "<density>1000</density></collision>"
    )


LINK = f"""<link name="a">{POSE}<inertial auto="false"><mass>1</mass>{POSE}<density>1</density><inertia><ixx>1</ixx>
  <iyy>1</iyy><izz>1</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>{_collisions()}{_visuals()}{SENSOR}
  {LIGHT}{PLUGIN}<gravity>1</gravity><enable_wind>0</enable_wind><self_collide>0</self_collide>
  <kinematic>0</kinematic><velocity_decay><linear>0</linear><angular>0</angular></velocity_decay></link>"""
MODEL = f"""<model name="m" canonical_link="a" placement_frame="">{POSE}<static>0</static>
  <self_collide>0</self_collide><allow_auto_disable>1</allow_auto_disable><enable_wind>0</enable_wind>{LINK}
  <link name="b"><inertial auto="true"/><collision name="c"><geometry>{SHAPES[1]}</geometry></collision></link>
  <joint name="leader" type="revolute"><parent>a</parent><child>b</child><axis/></joint>
  {joint("screw", "screw", f"<thread_pitch>1</thread_pitch><screw_thread_pitch>1</screw_thread_pitch>{SENSOR}{PLUGIN}")}
  {joint("gears", "gearbox", "<gearbox_ratio>2</gearbox_ratio><gearbox_reference_body>a</gearbox_reference_body>")}
  <joint name="old" type="fixed"><parent link="a"/><child link="b"/></joint>
  <frame name="f" attached_to="a">{POSE}</frame><model name="n"><link name="l"/></model>{PLUGIN}
  <ros2_control name="h" type="system"/>
  <include merge="false"><uri>model://box</uri><name>k</name>{POSE}<static>0</static>
  <placement_frame>l</placement_frame>{PLUGIN}<experimental:params/></include></model>"""
WORLD = f"""<sdf version="1.6"><world name="w">{MODEL}{LIGHT}{PLUGIN}<frame name="g" attached_to="world">{POSE}</frame>
  <include><uri>model://box</uri></include>
  <joint name="j" type="fixed"><parent>m::a</parent><child>m::n::l</child></joint>
  <physics name="p" default="1"><max_step_size>0.001</max_step_size><real_time_factor>1</real_time_factor>
    <real_time_update_rate>1000</real_time_update_rate><update_rate>1000</update_rate><max_contacts>10</max_contacts>
    <gravity>0 0 -1</gravity></physics>
  <gravity>0 0 -9.8</gravity><magnetic_field>0 0 0</magnetic_field><wind><linear_velocity>1 0 0</linear_velocity></wind>
  <atmosphere type="adiabatic"><temperature>288</temperature><temperature_gradient>-0.0065</temperature_gradient>
    <pressure>101325</pressure></atmosphere>
  <scene><ambient>1 1 1 1</ambient><background>1 1 1 1</background><shadows>1</shadows><grid>1</grid><sky/>
    <fog><type>exp</type><color>1 1 1 1</color><start>1</start><end>9</end><density>0.1</density></fog>
    <simkit:quality>fast</simkit:quality></scene><simkit:gazebo_quirks>true</simkit:gazebo_quirks>
  <spherical_coordinates><surface_model>EARTH_WGS84</surface_model><world_frame_orientation>ENU</world_frame_orientation>
    <latitude_deg>1</latitude_deg><longitude_deg>1</longitude_deg><elevation>1</elevation><heading_deg>0</heading_deg>
    <surface_axis_equatorial>1</surface_axis_equatorial><surface_axis_polar>1</surface_axis_polar>
    </spherical_coordinates>
  <population name="many"><model name="can"><link name="l"/></model><model_count>2</model_count>{POSE}
    <box><size>1 1 1</size></box><distribution><type>random</type></distribution></population>
  <population name="grid"><model name="tin"><link name="l"/></model><model_count>2</model_count>{POSE}
    <distribution><type>grid</type><rows>1</rows><cols>1</cols><step>1 1 0</step></distribution></population>
  <population name="round"><model name="pot"><link name="l"/></model><model_count>2</model_count>{POSE}
    <cylinder><radius>1</radius><length>1</length></cylinder>
    <distribution><type>uniform</type></distribution></population>
  <actor name="walker">{POSE}<skin><filename>w.dae</filename><scale>1</scale></skin><animation name="walk">
    <filename>w.dae</filename><scale>1</scale><interpolate_x>1</interpolate_x></animation><script><loop>1</loop>
    <delay_start>0</delay_start><auto_start>1</auto_start><trajectory id="0" type="walk"><tension>0</tension>
    <waypoint><time>0</time>{POSE}</waypoint></trajectory></script>{PLUGIN}
    <simkit:person><height>1.8</height><shirt>1 0 0</shirt><trousers>0 0 1</trousers><skin>1 1 1</skin>
    <hair>0 0 0</hair></simkit:person></actor>
  <actor name="ball"><link name="l">{POSE}<visual name="v"><geometry><sphere><radius>1</radius></sphere></geometry>
    </visual></link><script><trajectory id="0" type="roll"><waypoint><time>0</time>{POSE}</waypoint></trajectory>
    </script></actor>
  <state world_name="w"><sim_time>1 0</sim_time><wall_time>1 0</wall_time><real_time>1 0</real_time>
    <iterations>1</iterations><insertions><model name="new"><link name="l"/></model>
    <light name="late" type="point"/><include><uri>model://box</uri><name>late_box</name></include></insertions>
    <deletions><name>gone</name></deletions>
    <model name="m">{POSE}<scale>1 1 1</scale><link name="a">{POSE}<velocity>0 0 0 0 0 0</velocity>
      <acceleration>0 0 0 0 0 0</acceleration><wrench>0 0 0 0 0 0</wrench><collision name="c"/></link>
      <model name="n">{POSE}</model><joint name="screw"/><frame name="f">{POSE}</frame></model>
    <model_state name="new">{POSE}<link_state name="l">{POSE}<collision_state name="c"/></link_state></model_state>
    <light name="LAMP">{POSE}</light><light_state name="late">{POSE}</light_state></state>
  </world></sdf>"""
BARE = f'<sdf version="1.6"><light name="LAMP" type="point">{POSE}</light></sdf>'
BARE_INCLUDE = '<sdf version="1.6"><include><uri>model://box</uri></include></sdf>'
BOX = f'<sdf version="1.6"><model name="box"><link name="l">{LIGHT}</link></model></sdf>'
