"""Vehicles that drive over terrain: suspension, steering and wheels, in plain Python and numpy.

    vehicle = load_vehicle("rover.urdf")
    path = Path([(0, 0), (10, 4), (20, 0)], speed=0.5)
    state = vehicle.solve(path.pose(time), terrain)

`terrain` is a callable heights(xy (n, 2)) -> z (n,) in metres, or an object with `heights` and, if it
can, `gradients` or `normals`. Lengths are in metres, angles in degrees.
"""
from .kinematics.path import Path, PathPose
from .kinematics.terrain import GridTerrain
from .kinematics.vehicle import (CarriedModel, IndependentSuspension, RockerBogie, VehicleState,
                                 WheeledVehicle, load_vehicle)

__all__ = ["CarriedModel", "GridTerrain", "IndependentSuspension", "Path", "PathPose", "RockerBogie",
           "VehicleState", "WheeledVehicle", "load_vehicle"]
