"""Two nested tubes, one tendon on each: describe, solve, look, turn a tube, pull harder."""

from math import radians

import tactr
from tactr import Annulus, Material, Robot, Straight, Tendon, Tube

nitinol = Material(E=45e9, G=16.91e9, name="nitinol")
steel = Material(E=215e9, G=80e9, name="stainless steel")
outer = Tube("outer", length=0.140, section=Annulus(1.0e-3, 0.8e-3), material=nitinol)
inner = Tube("inner", length=0.180, section=Annulus(0.7e-3, 0.4e-3), material=steel)
bend_y = Tendon("outer", "outer", Straight(0.0, 6.5e-3), tension=3.0)
bend_x = Tendon("inner", "inner", Straight(6.5e-3, 0.0), tension=2.0)
robot = Robot([outer, inner], [bend_y, bend_x], name="two tubes")

shape = tactr.solve(robot)
print(shape)
print("outer tendon:", shape.tendons[0].length, "m long")

turned = tactr.solve(robot, rotation={"inner": radians(90)}, guess=shape)
print("inner tube turned by 90 deg:", turned.tip_position)

pulled = tactr.solve(robot, tension={"inner": 4.0}, guess=shape)
print("inner tendon pulled by 4 N:", pulled.tip_position)

tip = shape.tip_position
