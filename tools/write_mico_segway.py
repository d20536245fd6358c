"""Write robots/mico_segway/mico_segway.urdf from the published numbers of the Kinova Mico and the Segway RMP 110.

Run it from anywhere, without arguments; `tests/robots/test_mico_segway.py` compares the written file with this script.
Joints, masses, track, wheels, casters and the arm's place are published; what is ours is marked so. Every inertia is
that of a solid box, cylinder or sphere of the link's size. Drawn are the meshes of example-robot-data where Jaco and
Mico are the same, else primitives; contact is felt by primitives only.
"""

import math
from pathlib import Path

URDF = Path(__file__).resolve().parent.parent / "robots" / "mico_segway" / "mico_segway.urdf"
MESHES = "package://example-robot-data/robots/kinova_description/meshes"
PI = math.pi
Vector = tuple[float, float, float]
ZERO = (0.0, 0.0, 0.0)
LYING = (PI / 2, 0.0, 0.0)
"""Turns a cylinder's axis from z to y."""

COLOURS = {
    "black": "0.13 0.13 0.14 1",
    "shell": "0.18 0.18 0.19 1",
    "silver": "0.63 0.63 0.63 1",
    "plastic": "0.60 0.60 0.60 1",
    "rubber": "0.25 0.25 0.26 1",
    "white": "0.86 0.87 0.88 1",
    "aluminium": "0.72 0.73 0.75 1",
}


def numbers(values: Vector) -> str:
    """Three numbers as URDF wants them, without rounding that forward kinematics could feel."""
    return " ".join(f"{value:.12g}" for value in values)


class Part:
    """A solid or a mesh at a place in its link: text of its geometry, and moments of inertia of a unit mass."""

    def __init__(self, geometry: str, moments: Vector, colour: str, at: Vector, turned: Vector) -> None:
        """Keep geometry (XML), moments of inertia [m²], colour, and place [m] and roll, pitch, yaw [rad]."""
        self.geometry, self.moments, self.colour, self.at, self.turned = geometry, moments, colour, at, turned

    def written(self, kind: str) -> str:
        """A <visual> or <collision>."""
        colour = f'<material name="{self.colour}"/>' if kind == "visual" else ""
        origin = f'<origin xyz="{numbers(self.at)}" rpy="{numbers(self.turned)}"/>'
        return f"    <{kind}>{origin}<geometry>{self.geometry}</geometry>{colour}</{kind}>\n"


def box(size: Vector, at: Vector = ZERO, turned: Vector = ZERO, colour: str = "shell") -> Part:
    """A box by its whole sides [m]."""
    x, y, z = (side * side / 12 for side in size)
    return Part(f'<box size="{numbers(size)}"/>', (y + z, x + z, x + y), colour, at, turned)


def cylinder(radius: float, length: float, at: Vector = ZERO, turned: Vector = ZERO, colour: str = "shell") -> Part:
    """A cylinder along z [m]."""
    across = radius * radius / 4 + length * length / 12
    geometry = f'<cylinder radius="{radius:.12g}" length="{length:.12g}"/>'
    return Part(geometry, (across, across, radius * radius / 2), colour, at, turned)


def sphere(radius: float, at: Vector = ZERO, colour: str = "shell") -> Part:
    """A sphere [m]."""
    moment = 0.4 * radius * radius
    return Part(f'<sphere radius="{radius:.12g}"/>', (moment, moment, moment), colour, at, ZERO)


def mesh(name: str, colour: str = "shell") -> Part:
    """A mesh of the package, at its link's origin."""
    return Part(f'<mesh filename="{MESHES}/{name}.dae"/>', ZERO, colour, ZERO, ZERO)


def link(name: str, mass: float, solid: Part, drawn: list[Part], felt: list[Part], drive: float = 0.0) -> str:
    """A link whose mass [kg] is spread over a solid; the inertia of its joint's drive [kg m²] comes on top."""
    x, y, z = (mass * moment + drive for moment in solid.moments)
    inertia = f'<inertia ixx="{x:.6g}" iyy="{y:.6g}" izz="{z:.6g}" ixy="0" ixz="0" iyz="0"/>'
    origin = f'<origin xyz="{numbers(solid.at)}" rpy="{numbers(solid.turned)}"/>'
    shapes = "".join([part.written("visual") for part in drawn] + [part.written("collision") for part in felt])
    inertial = f'    <inertial>{origin}<mass value="{mass:.6g}"/>{inertia}</inertial>\n'
    return f'  <link name="{name}">\n{inertial}{shapes}  </link>\n'


def frame(name: str) -> str:
    """A link that is a frame only. PyBullet gives a link without inertia 1 kg, hence the gram."""
    return link(name, 0.001, sphere(0.05), [], [])


def joint(
    name: str, parent: str, child: str, at: Vector, turned: Vector = ZERO, kind: str = "fixed", more: str = ""
) -> str:
    """A joint by its place in the parent link."""
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    origin = f'<origin xyz="{numbers(at)}" rpy="{numbers(turned)}"/>'
    return f'  <joint name="{name}" type="{kind}">\n    {ends}\n    {origin}\n{more}  </joint>\n'


def moving(axis: str, velocity: float, effort: float, limits: tuple[float, float] | None = None) -> str:
    """Axis and limits of a moving joint: [rad/s], [Nm], [rad]."""
    bounds = f' lower="{limits[0]:.12g}" upper="{limits[1]:.12g}"' if limits else ""
    return f'    <axis xyz="{axis}"/>\n    <limit{bounds} velocity="{velocity:.12g}" effort="{effort:.12g}"/>\n'


# Segway RMP 110. The extent of chassis, mast and camera pole, and the mast's mass, are ours.
WHEEL_RADIUS, WHEEL_WIDTH, TRACK = 0.46228 / 2, 0.09225, 0.48122
WHEEL_SPEED = 0.5 / WHEEL_RADIUS + 0.5 * TRACK * 1.0 / WHEEL_RADIUS
"""Of the outer wheel at the largest speed and the largest turn together [rad/s]."""
CASTER_X, CASTER_RADIUS = 0.328, 0.05
ARM_BASE = (0.127, 0.0, 0.839)
CAMERA, LOOKED_AT = (0.02, 0.265, 1.36), (0.727, 0.0, 0.839)
"""The camera, and the middle of what it sees: 0.6 m before the arm, at the height of the arm's base [m]."""


def looking(eye: Vector, target: Vector) -> Vector:
    """Roll, pitch, yaw of an optical frame: z toward the target, x to the right, y down."""
    x, y, z = (b - a for a, b in zip(eye, target, strict=True))
    return (-PI / 2 - math.atan2(-z, math.hypot(x, y)), 0.0, math.atan2(y, x) - PI / 2)


def base() -> str:
    """Footprint, chassis, wheels, casters, mast and camera."""
    chassis = box((0.50, 0.36, 0.22), (0, 0, 0.23), colour="black")
    brackets = [box((0.14, 0.10, 0.03), (side * 0.315, 0, 0.125), colour="black") for side in (1, -1)]
    deck = box((0.46, 0.36, 0.02), (0, 0, 0.35), colour="white")
    text = frame("base_footprint") + joint("chassis_mount", "base_footprint", "chassis", ZERO)
    text += link("chassis", 29.76, chassis, [chassis, deck, *brackets], [chassis, *brackets])
    tyre = cylinder(WHEEL_RADIUS, WHEEL_WIDTH, turned=LYING, colour="rubber")
    # A tyre is round across: it stands on a narrow line, or it would scrub when the base turns on the spot.
    tread = cylinder(WHEEL_RADIUS, 0.010, turned=LYING)
    shoulder = cylinder(WHEEL_RADIUS - 0.005, WHEEL_WIDTH, turned=LYING)
    hub = cylinder(0.15, WHEEL_WIDTH + 0.006, turned=LYING, colour="silver")
    for side, y in (("left", TRACK / 2), ("right", -TRACK / 2)):
        more = moving("0 1 0", WHEEL_SPEED, 40)
        text += joint(f"wheel_{side}", "chassis", f"{side}_wheel", (0, y, WHEEL_RADIUS), kind="continuous", more=more)
        text += link(f"{side}_wheel", 4.20, tyre, [tyre, hub], [shoulder, tread])
    ball = sphere(CASTER_RADIUS, colour="rubber")
    stem = cylinder(0.02, 0.07, (0, 0, 0.045), colour="silver")
    for side, x in (("front", CASTER_X), ("back", -CASTER_X)):
        text += joint(f"caster_{side}_mount", "chassis", f"caster_{side}", (x, 0, CASTER_RADIUS))
        text += link(f"caster_{side}", 0.1, ball, [ball, stem], [ball])
    cabinet = box((0.24, 0.26, 0.24), (0.127, 0, 0.48), colour="white")
    column = box((0.10, 0.12, 0.23), (0.127, 0, 0.714), colour="aluminium")
    plate = box((0.16, 0.16, 0.012), (0.127, 0, 0.833), colour="black")
    pole_x, pole_y, top = CAMERA[0] - 0.03, 0.16, CAMERA[2]
    pole = cylinder(0.0125, top - 0.36, (pole_x, pole_y, (top + 0.36) / 2), colour="aluminium")
    boom = box((0.025, CAMERA[1] - pole_y + 0.025, 0.025), (pole_x, (CAMERA[1] + pole_y) / 2, top), colour="aluminium")
    text += joint("mast_mount", "chassis", "mast", ZERO)
    text += link("mast", 6.0, cabinet, [cabinet, column, plate, pole, boom], [cabinet, column, plate, pole, boom])
    case = box((0.18, 0.04, 0.035), (0, 0, -0.0175), colour="black")
    text += joint("camera_mount", "mast", "camera", CAMERA, looking(CAMERA, LOOKED_AT))
    return text + link("camera", 0.17, case, [case], [case])


# Kinova Mico m1n6s200: place and turn in the parent, limits [degree], velocity [degree/s], effort [Nm], mass [kg].
TURN = (-PI / 2, 0.0, PI)
BEND = (PI / 3, 0.0, PI)
WRIST = (0.0, -0.03703, -0.06414)
ARM: list[tuple[str, Vector, Vector, tuple[float, float] | None, float, float, float]] = [
    ("shoulder", (0, 0, 0.15675), (0, PI, 0), None, 36, 40, 0.748),
    ("upper_arm", (0, 0.0016, -0.11875), TURN, (50, 310), 36, 80, 0.860),
    ("forearm", (0, -0.290, 0), (0, PI, 0), (35, 325), 36, 40, 0.606),
    ("wrist_1", (0, 0.1231, -0.0086), TURN, None, 48, 20, 0.426),
    ("wrist_2", WRIST, BEND, None, 48, 20, 0.426),
    ("hand", WRIST, BEND, None, 48, 20, 0.780),
]


def arm_parts(name: str) -> tuple[Part, list[Part], list[Part]]:
    """Solid that spreads the mass, drawn parts and felt parts of an arm's link."""
    if name == "shoulder":
        upright, disc = cylinder(0.041, 0.075, (0, 0, -0.0375)), cylinder(0.041, 0.043, (0, -0.0199, -0.11875), LYING)
        solid = cylinder(0.041, 0.150, (0, -0.01, -0.0750))
        return solid, [mesh("shoulder"), mesh("ring_big", "silver")], [upright, disc]
    if name == "upper_arm":
        ends = [cylinder(0.041, 0.043, (0, y, -0.0215)) for y in (0, -0.290)]
        tube = cylinder(0.0345, 0.29, (0, -0.145, -0.0225), LYING)
        felt = box((0.072, 0.290, 0.043), (0, -0.145, -0.0215))
        return tube, [tube, *ends, mesh("ring_big", "silver")], [felt, *ends]
    if name == "forearm":
        end = cylinder(0.041, 0.043, (0, 0, -0.0215))
        tube = cylinder(0.0315, 0.1231, (0, 0.06155, -0.0086), LYING)
        return tube, [end, tube, mesh("ring_big", "silver")], [end, tube]
    if name == "hand":
        neck = cylinder(0.0315, 0.05, (0, 0, -0.025))
        palm = [box((0.050, 0.104, 0.036), (-0.003, 0, -0.080)), box((0.048, 0.050, 0.040), (-0.003, 0, -0.099))]
        solid = box((0.050, 0.090, 0.120), (-0.003, 0, -0.060))
        return solid, [mesh("hand_2finger"), mesh("ring_small", "silver")], [neck, *palm]
    # A wrist's pipe runs along its own axis, then along the next one's, 60 degrees off: two legs of equal length.
    leg = -WRIST[1] / math.sin(PI / 3)
    first = cylinder(0.0315, leg, (0, 0, -leg / 2))
    second = cylinder(0.0315, leg, (0, WRIST[1] / 2, -leg * 1.25), (-PI / 3, 0, 0))
    solid = cylinder(0.0315, 2 * leg, (0, WRIST[1] / 4, -0.85 * leg), (-PI / 6, 0, 0))
    return solid, [first, sphere(0.0315, (0, 0, -leg)), second, mesh("ring_small", "silver")], [first, second]


def arm() -> str:
    """The arm from its base to the hand, and the frames at the hand."""
    stand = cylinder(0.041, 0.157, (0, 0, 0.0785))
    text = joint("arm_mount", "mast", "arm_base", ARM_BASE) + link("arm_base", 0.468, stand, [mesh("base")], [stand])
    parent = "arm_base"
    for number, (name, at, turned, limits, velocity, effort, mass) in enumerate(ARM, start=1):
        radians = (math.radians(limits[0]), math.radians(limits[1])) if limits else None
        more = moving("0 0 1", math.radians(velocity), effort, radians)
        text += joint(f"joint_{number}", parent, name, at, turned, "revolute" if limits else "continuous", more)
        text += link(name, mass, *arm_parts(name))
        parent = name
    text += joint("end_effector_mount", "hand", "end_effector", (0, 0, -0.160), (PI, 0, PI / 2)) + frame("end_effector")
    return text + joint("tool_mount", "hand", "tool", (-0.0025, 0, -TOOL_DEPTH), (PI, 0, 0)) + frame("tool")


# The fingers. Published: the places, 0 to 1.51 and 0 to 2 rad, the masses. Ours: efforts, pads, and that the tips
# follow so that the pads stay parallel until the gap is 40 mm; a real tip is pulled by the same tendon as its finger.
FINGER_LEAN = 0.64926
PAD_LEAN = 0.17
"""How far a pad leans out of its phalanx [rad], as the drawn phalanx does on its inner side."""
PAD = (0.020, 0.0055)
"""Where the middle of a pad's face is in the finger tip [m]."""
TOOL_DEPTH = 0.178
FINGER_EFFORT, TIP_EFFORT = 2.0, 2.0
FINGER_DRIVE = 5e-4
"""Inertia of a finger's drive as its joint feels it through the screw [kg m²]. Without it a finger of 10 g squeezes
with a tenth of its torque in PyBullet, whose solver passes on no more than inertia times speed in an iteration."""


def fingers() -> str:
    """Two fingers of two phalanges; a pad's frame has x along it, y out of its face toward the other pad."""
    text = ""
    for number, side in ((1, 1), (2, -1)):
        at, turned = (-0.0025, side * 0.03095, -0.11482), (-PI / 2, FINGER_LEAN, side * PI / 2)
        more = moving("0 0 1", 1.0, FINGER_EFFORT, (0, 1.51))
        text += joint(f"finger_{number}", "hand", f"proximal_{number}", at, turned, "revolute", more)
        near = box((0.044, 0.019, 0.022), (0.022, -0.0095, 0), colour="plastic")
        text += link(f"proximal_{number}", 0.01, near, [mesh("finger_proximal", "plastic")], [near], FINGER_DRIVE)
        more = moving("0 0 1", 2.0, TIP_EFFORT, (0, 2))
        parallel = PI / 2 - FINGER_LEAN + PAD_LEAN
        more += f'    <mimic joint="finger_{number}" multiplier="-1" offset="{parallel:.12g}"/>\n'
        text += joint(
            f"finger_tip_{number}",
            f"proximal_{number}",
            f"distal_{number}",
            (0.044, -0.003, 0),
            more=more,
            kind="revolute",
        )
        far = box((0.044, 0.009, 0.020), (0.020, -0.0055, 0), (0, 0, 0.06), colour="plastic")
        inward = (math.sin(PAD_LEAN), math.cos(PAD_LEAN))
        middle = (PAD[0] - 0.002 * inward[0], PAD[1] - 0.002 * inward[1], 0.0)
        pad = box((0.036, 0.004, 0.020), middle, (0, 0, -PAD_LEAN), colour="rubber")
        text += link(f"distal_{number}", 0.01, far, [mesh("finger_distal", "plastic"), pad], [far, pad], FINGER_DRIVE)
        text += joint(f"pad_{number}_mount", f"distal_{number}", f"pad_{number}", (*PAD, 0.0), (0, 0, -PAD_LEAN))
        text += frame(f"pad_{number}")
    return text


HEAD = """<?xml version="1.0"?>
<!-- A Kinova Mico m1n6s200 with two fingers on a Segway RMP 110. Written by tools/write_mico_segway.py: change that.
     Metres, kilograms, radians. base_footprint is on the floor, x forward, y left; the arm stands at (0.127, 0, 0.839).
     tool: between the pads, z out of the hand, the fingers close along y. camera: z forward, x right, y down. -->
"""


def robot() -> str:
    """The whole file."""
    colours = "".join(
        f'  <material name="{name}"><color rgba="{rgba}"/></material>\n' for name, rgba in COLOURS.items()
    )
    return f'{HEAD}<robot name="mico_segway">\n{colours}{base()}{arm()}{fingers()}</robot>\n'


if __name__ == "__main__":
    URDF.write_text(robot(), encoding="utf-8")
