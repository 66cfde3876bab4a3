"""Makes Data/rover: a six-wheeled rocker-bogie rover of our own design, as URDF with glTF meshes.

    python3 make_rover.py [folder]

X forward, Y left, Z up, metres. The root link's origin is on the ground below the middle wheels'
axle when all joints are zero. Every dimension that kinematics need stands once, in `Layout`, and
reaches the URDF as joint origins and the wheels' collision cylinders.
"""
import sys
from pathlib import Path

import numpy as np

from meshkit import write_gltf, write_png
from rover_finish import MATERIALS, texture
from rover_shapes import Layout, parts


class Urdf:
    """URDF text in the making; links and joints in the order they are added."""

    def __init__(self, name):
        self.lines = ['<?xml version="1.0"?>',
                      "<!-- Made by Data/generators/make_rover.py; X forward, Y left, Z up, metres.",
                      "     Meshes are in link axes (Z up); wheel radius and width are those of the",
                      "     wheels' collision cylinders. -->", f'<robot name="{name}">']

    @staticmethod
    def numbers(values):
        return " ".join(f"{round(float(v), 6) + 0.0:g}" for v in values)

    def link(self, name, mesh=None, rpy=None, wheel=False):
        if mesh is None:
            self.lines.append(f'  <link name="{name}"/>')
            return
        origin = f'<origin xyz="0 0 0" rpy="{self.numbers(rpy)}"/>' if rpy else ""
        self.lines += [f'  <link name="{name}">',
                       f'    <visual>{origin}<geometry><mesh filename="{mesh}"/></geometry></visual>']
        if wheel:
            self.lines += [f'    <collision><origin xyz="0 0 0" rpy="{np.pi / 2:.10f} 0 0"/><geometry>'
                           f'<cylinder radius="{Layout.wheel_radius}" length="{Layout.wheel_width}"/>'
                           "</geometry></collision>"]
        self.lines.append("  </link>")

    def joint(self, name, kind, parent, child, xyz, axis=None, limits_deg=None, mimic=None, rpy=(0, 0, 0)):
        turned = f' rpy="{self.numbers(rpy)}"' if any(rpy) else ""
        self.lines += [f'  <joint name="{name}" type="{kind}">',
                       f'    <parent link="{parent}"/><child link="{child}"/>',
                       f'    <origin xyz="{self.numbers(xyz)}"{turned}/>']
        if axis:
            self.lines.append(f'    <axis xyz="{self.numbers(axis)}"/>')
        if limits_deg:
            low, high = np.radians(limits_deg)
            self.lines.append(f'    <limit lower="{low:.6f}" upper="{high:.6f}" effort="50" velocity="1"/>')
        if mimic:
            self.lines.append(f'    <mimic joint="{mimic}" multiplier="-1" offset="0"/>')
        self.lines.append("  </joint>")

    def text(self):
        return "\n".join(self.lines + ["</robot>", ""])


def urdf():
    """The rover's URDF. Positive angles follow the right-hand rule: rockers and bogies nose down,
    steering to the left, wheels forwards, mast to the left and its head down."""
    u, o = Urdf("dspace_rover"), Layout
    y, z, flip = (0, 1, 0), (0, 0, 1), np.array([1, -1, 1])
    u.link("chassis", "chassis.gltf")
    for side, s in (("left", 1), ("right", -1)):
        m = flip if s < 0 else np.ones(3)
        turned = (0, 0, np.pi) if s < 0 else None
        u.link(f"rocker_{side}", f"rocker_{side}.glb")
        u.joint(f"rocker_{side}", "revolute", "chassis", f"rocker_{side}", o.rocker * m, y, (-25, 25),
                "rocker_left" if s < 0 else None)
        u.link(f"bogie_{side}", f"bogie_{side}.glb")
        u.joint(f"bogie_{side}", "revolute", f"rocker_{side}", f"bogie_{side}", (o.bogie - o.rocker) * m,
                y, (-35, 35))
        for place, parent, at, x in (("front", "rocker", o.rocker, o.front_x), ("rear", "bogie", o.bogie, o.rear_x)):
            corner = f"{place}_{side}"
            u.link(f"steer_{corner}", f"steer_{side}.glb")
            u.joint(f"steer_{corner}", "revolute", f"{parent}_{side}", f"steer_{corner}",
                    (np.array([x, o.wheel_y, o.steer_z]) - at) * m, z, (-60, 60))
            u.link(f"wheel_{corner}", "wheel.glb", turned, wheel=True)
            u.joint(f"wheel_{corner}", "continuous", f"steer_{corner}", f"wheel_{corner}",
                    (0, 0, o.wheel_radius - o.steer_z), y)
        u.link(f"wheel_middle_{side}", "wheel.glb", turned, wheel=True)
        u.joint(f"wheel_middle_{side}", "continuous", f"bogie_{side}", f"wheel_middle_{side}",
                (np.array([o.middle_x, o.wheel_y, o.wheel_radius]) - o.bogie) * m, y)
    u.link("mast", "mast.glb")
    u.joint("mast_mount", "fixed", "chassis", "mast", o.mast)
    u.link("mast_pan", "mast_pan.glb")
    u.joint("mast_pan", "revolute", "mast", "mast_pan", (0, 0, o.mast_pan_z), z, (-180, 180))
    u.link("mast_head", "mast_head.glb")
    u.joint("mast_tilt", "revolute", "mast_pan", "mast_head", (0, 0, o.mast_tilt_z), y, (-80, 80))
    camera = (-np.pi / 2, 0, -np.pi / 2)  # sensor axes: X right, Y down, Z forward
    for name, link, xyz in (("mast_camera", "mast_head", (0.124, 0, 0.08)),
                            ("mast_camera_left", "mast_head", (0.124, 0.115, 0.08)),
                            ("mast_camera_right", "mast_head", (0.124, -0.115, 0.08))):
        u.link(name)
        u.joint(f"{name}_mount", "fixed", link, name, xyz, rpy=camera)
    u.link("hazard_camera_front")
    u.joint("hazard_camera_front_mount", "fixed", "chassis", "hazard_camera_front", (0.605, -0.05, 0.64),
            rpy=(-np.pi / 2 - np.radians(25), 0, -np.pi / 2))
    u.link("hazard_camera_rear")
    u.joint("hazard_camera_rear_mount", "fixed", "chassis", "hazard_camera_rear", (-0.635, 0, 0.65),
            rpy=(-np.pi / 2 - np.radians(25), 0, np.pi / 2))
    u.link("antenna_mount", "antenna_mount.glb")
    u.joint("antenna_mount", "fixed", "chassis", "antenna_mount", o.antenna)
    u.link("antenna_post", "antenna_post.glb")
    u.joint("antenna_azimuth", "revolute", "antenna_mount", "antenna_post", (0, 0, o.antenna_z), z, (-180, 180))
    u.link("antenna_dish", "antenna_dish.glb")
    # Zero is the boresight 50 degrees above the horizon.
    u.joint("antenna_elevation", "revolute", "antenna_post", "antenna_dish", (0, 0, o.dish_z), y, (-40, 50),
            rpy=(0, -np.radians(50), 0))
    x = (1, 0, 0)
    chain = [("arm_shoulder", "arm_yaw", "chassis", o.arm, z, (-90, 90)),
             ("arm_upper", "arm_pitch", "arm_shoulder", (0.06, 0, 0), x, (-120, 60)),
             ("arm_fore", "arm_elbow", "arm_upper", (0.058, -o.upper_arm, 0), x, (0, 300)),
             ("arm_turret", "arm_wrist", "arm_fore", (0, o.fore_arm, 0), x, (-180, 180))]
    for link, joint, parent, xyz, axis, limits in chain:
        u.link(link, f"{link}.glb")
        u.joint(joint, "revolute", parent, link, xyz, axis, limits)
    return u.text()


def make(folder):
    """Writes rover.urdf, the meshes and their texture into `folder`."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, part in parts().items():
        write_gltf(part, folder / name, MATERIALS, "deck.png")
    write_png(folder / "deck.png", texture())
    (folder / "rover.urdf").write_text(urdf())


if __name__ == "__main__":
    make(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "rover")
