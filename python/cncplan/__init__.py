"""Motion planning for CNC machines: G-code to jerk-limited, smoothed motion.

    import cncplan

    machine = cncplan.Machine(velocity=30, acceleration=1000, jerk=10000)  # limits of the tool
    trajectory = cncplan.plan_file("part.ngc", machine, tolerance=0.01)
    samples = trajectory.sample(0.001)  # arrays of NumPy

Lengths are mm, angles rad and times s in all arrays. What describes a machine has degrees for rotary axes, as machine
files and G-code do. Errors are `cncplan.Error`, a ValueError; a wrong type is a TypeError.
"""

from ._blocks import Block, arc, curve, line
from ._core import version as __version__
from ._errors import Error
from ._executor import Executor
from ._machine import Axis, Machine
from ._motion import (CurveMotion, Motion, Profile, ProfileState, State, move_to, profile, reach_velocity,
                      time_optimal)
from ._program import Program, read_program, write_gcode
from ._trajectory import Peaks, Samples, SetPoint, Trajectory, plan_blocks, plan_file, plan_text

__all__ = ["Axis", "Block", "CurveMotion", "Error", "Executor", "Machine", "Motion", "Peaks", "Profile", "ProfileState",
           "Program", "Samples", "SetPoint", "State", "Trajectory", "arc", "curve", "line", "move_to", "plan_blocks",
           "plan_file", "plan_text", "profile", "reach_velocity", "read_program", "time_optimal", "write_gcode"]
