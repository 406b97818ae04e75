"""The mobile base PMB2: hull, drive wheels on their suspension, casters, laser, sonars, IMU, microphones, antennas."""

from __future__ import annotations

from parts import (
    BLACK,
    DARK,
    GREY,
    HALF,
    METAL,
    ORANGE,
    QUARTER,
    WHITE,
    Collision,
    Contact,
    Limit,
    Link,
    Sensor,
    Visual,
    box,
    cylinder,
    drawn,
    sphere,
)

WHEEL_RADIUS = 0.0985
WHEEL_Y = 0.2022
CASTER_RADIUS = 0.025
WHEEL = Contact(1.0, 1e6, 100.0)
CASTER = Contact(1.0, 1e6, 1e4)

HULL = (
    Collision("lid", cylinder(0.25, 0.0805), (0, 0, 0.15725)),
    Collision("ring", cylinder(0.267, 0.013), (0, 0, 0.1105)),
    Collision("middle", box(0.395, 0.20, 0.149), (-0.0475, 0, 0.0295)),
    Collision("front", box(0.083, 0.36, 0.074), (0.1465, 0, 0.067)),
    Collision("nose", box(0.095, 0.20, 0.074), (0.1975, 0, 0.067)),
    Collision("chin", box(0.03, 0.20, 0.053), (0.230, 0, -0.0465)),
    Collision("back", box(0.083, 0.36, 0.149), (-0.1465, 0, 0.0295)),
)
"""A drum of radius 267 mm with room for the wheels and for casters that swivel; between chin and nose lies the slot of
the laser. No shape of the hull meets another link's, and no ray starts or ends in one."""


def ray_noise(deviation: float) -> str:
    return f"<noise><type>gaussian</type><mean>0</mean><stddev>{deviation:g}</stddev></noise>"


def laser() -> Link:
    lines = (
        "<ray>",
        "  <scan>",
        "    <horizontal>",
        "      <samples>666</samples><resolution>1</resolution>",
        "      <min_angle>-1.9198621771937625</min_angle><max_angle>1.9198621771937625</max_angle>",
        "    </horizontal>",
        "  </scan>",
        "  <range><min>0.05</min><max>25</max><resolution>0.001</resolution></range>",
        f"  {ray_noise(0.06)}",
        "</ray>",
        '<plugin name="base_laser" filename="libgazebo_ros_ray_sensor.so">',
        "  <ros><remapping>~/out:=scan_raw</remapping></ros>",
        "  <output_type>sensor_msgs/LaserScan</output_type>",
        "  <frame_name>base_laser_link</frame_name>",
        "</plugin>",
    )
    return Link(
        "base_laser_link",
        "base_laser_joint",
        "base_link",
        xyz=(0.202, 0, -0.004),
        mass=0.28922,
        inertia=(2.628919e-5, 3.374542e-5, 5.832599e-5, 2.4298e-7, -3.68129e-6, -1.33e-8),
        centre=(-0.02559, -0.00056, -0.05732),
        visuals=drawn(("housing", "laser_housing", DARK)),
        sensors=(Sensor("base_laser", "ray", 10, lines),),
        about="SICK TiM571 behind the slot in the hull; the origin lies in the scan plane.",
    )


def sonar(number: str, x: float, y: float, yaw: float) -> Link:
    name = f"base_sonar_{number}"
    fan = "<samples>5</samples><resolution>1</resolution><min_angle>-0.25</min_angle><max_angle>0.25</max_angle>"
    lines = (
        "<ray>",
        f"  <scan><horizontal>{fan}</horizontal><vertical>{fan}</vertical></scan>",
        "  <range><min>0.02</min><max>1</max><resolution>0.01</resolution></range>",
        f"  {ray_noise(0.005)}",
        "</ray>",
        f'<plugin name="{name}_gazebo_ros_range" filename="libgazebo_ros_ray_sensor.so">',
        "  <ros><remapping>~/out:=sonar_base</remapping></ros>",
        "  <output_type>sensor_msgs/Range</output_type>",
        "  <radiation_type>ultrasound</radiation_type>",
        f"  <frame_name>{name}_link</frame_name>",
        "</plugin>",
    )
    return Link(
        f"{name}_link",
        f"{name}_joint",
        "base_link",
        xyz=(x, y, 0.173),
        rpy=(0, 0, yaw),
        mass=0.001,
        inertia=(1e-6, 1e-6, 1e-6),
        visuals=(Visual("capsule", cylinder(0.008, 0.012), DARK, rpy=(0, QUARTER, 0)),),
        sensors=(Sensor(name, "ray", 5, lines),),
        about="Ultrasonic range finders at the rear; x is the middle of the cone." if number == "01" else "",
    )


def microphone(name: str, x: float, y: float) -> Link:
    return Link(f"base_mic_{name}_link", f"base_mic_{name}_joint", "base_link", xyz=(x, y, 0.195))


def antenna(side: str, y: float) -> Link:
    rod = cylinder(0.005, 0.17)
    return Link(
        f"base_antenna_{side}_link",
        f"base_antenna_{side}_joint",
        "base_link",
        xyz=(-0.201, y, 0.195),
        collisions=(Collision("rod", rod, (0, 0, 0.085)),),
        visuals=(Visual("rod", rod, BLACK, (0, 0, 0.085)),),
    )


def imu() -> Link:
    def sensor(name: str, rate: float, *plugin: str) -> Sensor:
        def axes(deviation: str, mean: str, bias: str) -> list[str]:
            white = f"<mean>0</mean><stddev>{deviation}</stddev>"
            drift = f"<bias_mean>{mean}</bias_mean><bias_stddev>{bias}</bias_stddev>"
            return [f'    <{axis}><noise type="gaussian">{white}{drift}</noise></{axis}>' for axis in "xyz"]

        lines = (
            "<imu>",
            "  <angular_velocity>",
            *axes("2e-4", "7.5e-6", "8e-7"),
            "  </angular_velocity>",
            "  <linear_acceleration>",
            *axes("1.7e-2", "0.1", "0.001"),
            "  </linear_acceleration>",
            "</imu>",
            *plugin,
        )
        return Sensor(name, "imu", rate, lines)

    driver = (
        '<plugin name="base_imu" filename="libgazebo_ros_imu_sensor.so">',
        "  <ros><remapping>~/out:=base_imu</remapping></ros>",
        "</plugin>",
    )
    return Link(
        "base_imu_link",
        "base_imu_joint",
        "base_link",
        xyz=(0.10171, 0, 0.11282),
        rpy=(0, 0, -QUARTER),
        mass=0.01,
        inertia=(1e-6, 1e-6, 1e-6),
        sensors=(sensor("imu_sensor", 10, *driver), sensor("base_imu_sensor", 100)),
        about="IMU, turned a quarter to the right. Two sensors: one with a topic, one for the controllers.",
    )


def wheel(side: str) -> tuple[Link, Link]:
    sign = 1 if side == "left" else -1
    suspension = Link(
        f"suspension_{side}_link",
        f"suspension_{side}_joint",
        "base_link",
        "prismatic",
        limit=Limit(100, 1, -0.005, 0.005, k_position=0, k_velocity=10),
        damping=100,
        mass=10,
        inertia=(1, 1, 1),
        centre=(0, 0, -0.02),
        about="The suspension's travel is 5 mm up and down; motor and gear are its 10 kg." if sign > 0 else "",
    )
    tyre = Link(
        f"wheel_{side}_link",
        f"wheel_{side}_joint",
        suspension.name,
        "continuous",
        (0, sign * WHEEL_Y, 0),
        (-QUARTER, 0, 0),
        limit=Limit(6, 10.152284263959391),
        damping=1,
        friction=2,
        mass=1.82362,
        inertia=(0.00499743171, 0.00499741733, 0.00839239692, sign * -4.464e-8, -2.245e-8, sign * 1.64e-9),
        centre=(0, 0, sign * 0.00207),
        contact=WHEEL,
        collisions=(Collision("tread", sphere(WHEEL_RADIUS)),),
        visuals=drawn(("tyre", "wheel_tyre", BLACK), ("rim", "wheel_rim", GREY)),
        about="Touches the ground at one point, as a sphere; z is the axle and points to the left." if sign > 0 else "",
    )
    return suspension, tyre


def caster(end: str, side: str) -> tuple[Link, Link]:
    name = f"caster_{end}_{side}"
    x, y = (0.1695 if end == "front" else -0.1735), (0.102 if side == "left" else -0.102)
    fork = Link(
        f"{name}_1_link",
        f"{name}_1_joint",
        "base_link",
        "continuous",
        (x, y, -0.0335),
        damping=0.015,
        mass=0.05144761,
        inertia=(1.513e-5, 1.309e-5, 1.198e-5, -3e-8, 2.67e-6, -5e-8),
        centre=(-0.00634599, 0.00005347, -0.02037519),
        contact=CASTER,
        visuals=drawn(("fork", "caster_fork", METAL)),
        about="A caster: the fork turns about the vertical, its wheel trails 16 mm behind.",
    )
    roll = Link(
        f"{name}_2_link",
        f"{name}_2_joint",
        fork.name,
        "continuous",
        (-0.016, 0, -0.040),
        (-QUARTER, 0, 0),
        damping=0.015,
        mass=0.08855784,
        inertia=(1.075e-5, 1.541e-5, 1.075e-5),
        contact=CASTER,
        collisions=(Collision("tread", sphere(CASTER_RADIUS)),),
        visuals=(Visual("tyre", cylinder(CASTER_RADIUS, 0.02), BLACK),),
    )
    return fork, roll


def base_links() -> tuple[Link, ...]:
    """PMB2, base_footprint first."""
    footprint = Link("base_footprint", about="The model's origin: on the ground, midway between the wheels.")
    hull = Link(
        "base_link",
        "base_footprint_joint",
        "base_footprint",
        xyz=(0, 0, WHEEL_RADIUS),
        mass=28.26649,
        inertia=(0.465408937, 0.483193291, 0.550939703, 0.002160024, -0.001760255, -0.000655952),
        centre=(-1.06e-6, 1.09e-6, 3.87e-5),
        contact=Contact(0.1, 1e8, 10.0),
        collisions=HULL,
        visuals=drawn(("top", "hull_top", WHITE), ("skirt", "hull_skirt", WHITE), ("core", "hull_core", DARK)),
        about="Hull with batteries and computer; the origin lies on the axle.",
    )
    cover = Link(
        "base_cover_link",
        "cover_joint",
        "base_footprint",
        xyz=(0, 0, 0.13),
        mass=0.25821,
        inertia=(2.3719188e-4, 2.8335052e-4, 3.8497063e-4, 6.119e-8, -1.1799e-7, 7.74e-9),
        centre=(0.22414, 0.00002, 0.04681),
        visuals=drawn(("band", "cover_ring", ORANGE), ("ring", "cover_ring_base", WHITE)),
        about="The ring around the hull.",
    )
    return (
        footprint,
        hull,
        cover,
        laser(),
        sonar("01", -0.183, -0.183, 1.25 * HALF),
        sonar("02", -0.259, 0, HALF),
        sonar("03", -0.183, 0.183, 0.75 * HALF),
        microphone("front_left", 0.23182, 0.03902),
        microphone("front_right", 0.23182, -0.03902),
        microphone("back_left", -0.1082, -0.0599),
        microphone("back_right", -0.1082, -0.13789),
        antenna("left", 0.1062),
        antenna("right", -0.1062),
        imu(),
        *wheel("left"),
        *wheel("right"),
        *caster("front", "left"),
        *caster("front", "right"),
        *caster("back", "left"),
        *caster("back", "right"),
    )
