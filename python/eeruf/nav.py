"""From range readings to motion: a certainty grid (HIMM) and the vector field histogram (VFH) over it.

Example:
    >>> from eeruf import nav, sim
    >>> robot = sim.Robot((-2, 0.2, 0), sensors=16, spacing_rad=0.26, radius_m=0.2)
    >>> scene = sim.Scene([[9, -9, 9, 9]], poles=[[0, 0, 0.05]], robots=[robot])
    >>> world, grid, vfh = sim.Simulation(scene), nav.Himm(side=129), nav.Vfh()
    >>> while world.robots[0].pose[0] < 2 and not world.robots[0].touches:
    ...     grid.enter(world.step(0.06))
    ...     world.set_velocity(0, *vfh.drive(grid, world.robots[0].pose, target=(4, 0)))
    >>> world.robots[0].touches
    False

"""

from eeruf._eeruf import Himm, Vfh

__all__ = ["Himm", "Vfh"]
