"""MJCF models of these tests: what users write, and random ones that mix every way to write it."""

import numpy as np

ARM = """<mujoco model="arm">
  <compiler angle="degree" autolimits="true" meshdir="meshes"/>
  <default>
    <joint damping="2" frictionloss="0.5" range="-170 170"/>
    <geom contype="0" conaffinity="0" density="500"/>
    <default class="wrist">
      <joint range="-120 120" actuatorfrcrange="-30 20"/>
      <general forcerange="-12 12" gear="2"/>
      <default class="tool"><joint type="slide" axis="1 0 0" range="0 0.1"/></default>
    </default>
    <default class="solid"><geom contype="1" group="3" rgba="1 0 0 1"/></default>
  </default>
  <asset>
    <material name="steel" rgba="0.5 0.6 0.7 1"/>
    <mesh file="link.stl" scale="0.001 0.001 0.001"/>
    <mesh name="cover" file="parts/cover.obj" refpos="0 0 0.1"/>
  </asset>
  <worldbody>
    <light pos="0 0 3"/>
    <geom name="floor" type="plane" size="1 1 0.1"/>
    <body name="base" pos="0 0 0.1" euler="0 0 90">
      <inertial mass="4" pos="0 0 0.05" diaginertia="0.1 0.2 0.25"/>
      <geom type="box" size="0.1 0.2 0.05" material="steel" group="1"/>
      <body name="upper" pos="0 0 0.2" quat="1 1 0 0">
        <joint name="pan" axis="0 1 0"/>
        <joint name="lift" axis="0 0 2" pos="0.1 0 0" ref="30" range="-90 100"/>
        <geom type="capsule" fromto="0 0 0 0 0.4 0" size="0.05" mass="2"/>
        <geom class="solid" type="cylinder" size="0.06 0.2" pos="0 0.2 0" zaxis="0 1 0" mass="0"/>
        <geom type="mesh" mesh="link" mass="0"/>
        <frame pos="0 0.4 0" xyaxes="0 1 0 -1 0 0" childclass="wrist">
          <body name="fore" axisangle="0 0 1 45">
            <joint name="elbow" axis="0 1 1"/>
            <geom size="0.1"/>
            <frame pos="0.3 0 0" euler="0 90 0">
              <site name="camera" pos="0.01 0 0" zaxis="0 0 -1"/>
              <geom type="mesh" mesh="cover" density="0" class="solid"/>
            </frame>
            <body name="hand" pos="0.3 0 0">
              <joint name="grip" class="tool"/>
              <geom type="ellipsoid" size="0.1 0.05 0.02"/>
              <site name="hand" pos="0.05 0 0"/>
            </body>
            <body name="other" pos="0.3 0 0.1">
              <joint name="mirror" class="tool" ref="0.02"/>
              <geom type="box" size="0.01 0.02 0.03" euler="10 20 30" pos="0.01 0.02 0.03"/>
            </body>
          </body>
        </frame>
      </body>
    </body>
  </worldbody>
  <equality>
    <joint joint1="mirror" joint2="grip" polycoef="0.01 -0.5 0 0 0"/>
    <connect body1="hand" body2="base" anchor="0.1 0 0" active="false"/>
  </equality>
  <actuator>
    <motor joint="pan" ctrlrange="-3 2" gear="10"/>
    <position joint="lift" kp="100" forcerange="-50 40"/>
    <general joint="elbow" class="wrist"/>
    <velocity joint="grip"/>
  </actuator>
  <keyframe>
    <key name="home" qpos="0.1 0.2 0.3 0.04 0.05"/>
    <key qpos="1 1 1 0 0"/>
    <key name="moment" time="1"/>
  </keyframe>
</mujoco>
"""


def numbers(values):
    return '"' + " ".join(repr(float(value)) for value in values) + '"'


def orientation(rng):
    """One of the ways to turn a frame, or none."""
    choice = int(rng.integers(6))
    if choice == 0:
        return f" quat={numbers(rng.normal(size=4))}"
    if choice == 1:
        return f" axisangle={numbers([*rng.normal(size=3), rng.uniform(-200, 200)])}"
    if choice == 2:
        return f" euler={numbers(rng.uniform(-200, 200, 3))}"
    if choice == 3:
        return f" xyaxes={numbers(rng.normal(size=6))}"
    if choice == 4:
        return f" zaxis={numbers(rng.normal(size=3))}"
    return ""


def place(rng):
    return f" pos={numbers(rng.normal(size=3))}" * bool(rng.integers(2)) + orientation(rng)


def joint(rng, name):
    """A hinge or a slide with some of: a class, an axis, an anchor, a reference, a range."""
    parts = [
        ' class="slides"' if rng.random() < 0.3 else ' type="hinge"' if rng.random() < 0.5 else "",
        f" axis={numbers(rng.normal(size=3))}",
        f" pos={numbers(rng.normal(size=3))}",
        f' ref="{rng.uniform(-90, 90)!r}"',
        f" range={numbers(np.sort(rng.uniform(-180, 180, 2)))}",
    ]
    kept = "".join(part for part in parts if rng.random() < 0.6)
    return f'<joint name="{name}"{kept}/>'


def geom(rng):
    """A solid with a mass of its own or a density."""
    kind = ("sphere", "capsule", "cylinder", "box", "ellipsoid")[int(rng.integers(5))]
    size = numbers(rng.uniform(0.1, 1.0, {"sphere": 1, "capsule": 2, "cylinder": 2}.get(kind, 3)))
    where = place(rng)
    if kind != "sphere" and rng.random() < 0.3:
        where = f" fromto={numbers(rng.normal(size=6))}"
    weight = ("", f' mass="{rng.uniform(0.1, 2)!r}"', f' density="{rng.uniform(1, 9)!r}"')[
        int(rng.integers(3))
    ]
    return f'<geom type="{kind}" size={size}{where}{weight} group="{int(rng.integers(5))}"/>'


def random_model(rng, n=8):
    """A tree of n bodies with a few joints, geoms and sites each, some of them inside frames."""
    children = {k: [] for k in range(n)}
    for k in range(1, n):
        children[int(rng.integers(max(0, k - 3), k))].append(k)

    def body(k):
        inside = [joint(rng, f"j{k}_{i}") for i in range(int(rng.integers(3)))]
        inside += [geom(rng) for _ in range(int(rng.integers(1, 4)))]
        inside += [f'<site name="s{k}_{i}"{place(rng)}/>' for i in range(int(rng.integers(2)))]
        if rng.random() < 0.3:
            mass, moments = rng.uniform(0.1, 3), rng.uniform(1.0, 1.9, 3)
            inside.append(
                f'<inertial mass="{mass!r}" diaginertia={numbers(moments)} pos="1 2 3"{orientation(rng)}/>'
            )
        inside += [body(child) for child in children[k]]
        if rng.random() < 0.4:
            split = int(rng.integers(len(inside) + 1))
            inside = [*inside[:split], f"<frame{place(rng)}>", *inside[split:], "</frame>"]
        around = ' childclass="slides"' if rng.random() < 0.2 else ""
        return "\n".join([f'<body name="b{k}"{around}{place(rng)}>', *inside, "</body>"])

    sequence = "".join(rng.choice(list("xyzXYZ"), 3))
    unit = ("degree", "radian")[int(rng.integers(2))]
    from_geoms = ("auto", "true", "false")[int(rng.integers(3))]
    return f"""<mujoco model="random">
<compiler angle="{unit}" eulerseq="{sequence}" inertiafromgeom="{from_geoms}" inertiagrouprange="0 3"
  boundmass="0.01" boundinertia="0.001" balanceinertia="true"/>
<default><joint axis="1 1 0"/><default class="slides"><joint type="slide" pos="0.5 0 0"/></default></default>
<worldbody>{body(0)}</worldbody></mujoco>"""
