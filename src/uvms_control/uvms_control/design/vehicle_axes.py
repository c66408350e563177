"""The six axes of a vehicle as the design of its loop sees them, from the vehicle file."""

from dataclasses import dataclass

import numpy as np

from uvms_control.controlled_axes import axes_of
from uvms_control.design.axis import Axis
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.resistance import axis_resistance
from uvms_core.vehicle.statics import first_moment
from uvms_dynamics import build_model, mass_matrix
from uvms_dynamics.external_bandwidth import external_bandwidth
from uvms_dynamics.sensor_noise import sensor_noise


@dataclass(frozen=True)
class Timing:
    """When the loop acts."""

    period: float  # of the control loop, s
    delay: float = 0.0  # from the sensors' stamp to the thrusters' command, s
    lag_compensated: float = 0.0  # share of the thrusters' lag that the allocator makes up for
    external: float | None = None  # bandwidth of the external wrench, rad/s; None: by rule


def vehicle_axes(vehicle: Vehicle, q: Array, timing: Timing) -> tuple[Axis | None, ...]:
    """Surge, sway, heave, roll, pitch, yaw near level; None: it is left to the hull.

    q (n,) rad: posture of the arm. Inertia is the diagonal of the whole system's mass matrix (what
    the thrusters must move), righting that of weight and buoyancy about a level vehicle, drag the
    hull's linear part, lag that of the slowest thruster that acts on the axis.
    """
    inertia = np.diag(mass_matrix(build_model(vehicle), np.ascontiguousarray(q, dtype=float)))
    metacentric = float(first_moment(vehicle, q)[2])
    righting = np.array([0.0, 0.0, 0.0, metacentric, metacentric, 0.0])
    drag, _ = axis_resistance(vehicle.hull, vehicle.environment.water_density_kg_m3)
    pose, rate = sensor_noise(vehicle)
    authority, lag = axis_thrust(vehicle)
    external = external_bandwidth(vehicle, timing.period)
    if timing.external is not None:
        external = np.full(6, timing.external)
    return tuple(
        Axis(
            inertia=float(inertia[k]),
            righting=float(righting[k]),
            drag=float(drag[k]),
            period=timing.period,
            lag=float(lag[k]),
            lag_compensated=timing.lag_compensated,
            delay=timing.delay,
            authority=float(authority[k]),
            position_noise=float(pose[k]),
            rate_noise=float(rate[k]),
            observer=float(external[k]),
        )
        if authority[k] > 0.0
        else None
        for k in range(6)
    )


def axis_thrust(vehicle: Vehicle) -> tuple[Array, Array]:
    """Authority (6,), N and N m, and lag (6,), s, of the axes that the thrusters control.

    0 along the others, which are left to the hull; see `ControlledAxes`.
    """
    axes = axes_of(vehicle)
    return axes.authority, axes.lag
