"""Control law `paper`: the vehicle by eq. (22) as printed, the arm by eq. (19)."""

from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from uvms_control.config import ControlConfig
from uvms_control.controller import NO_MONITOR, Controller
from uvms_control.design.conditions import Gains, check_slopes
from uvms_control.design.vehicle_axes import Timing, vehicle_axes
from uvms_control.reference import ReferenceSample
from uvms_control.stability import StabilityMonitor
from uvms_control.tracking_error import tracking_error
from uvms_control.vehicle_controller import VehicleController
from uvms_core.signals import Array, Odometry
from uvms_core.vehicle.plausible.stability import postures
from uvms_core.vehicle.postures import STOWED
from uvms_dynamics import hull_bias_wrench, mass_matrix


class PaperController(Controller):
    """As `Controller`, with the vehicle's law of the paper; see `VehicleController`.

    It cancels the righting moment of the hull and drives the vehicle with a current: the law to
    compare with, not the one to dive with (docs/control.md).
    """

    ignores: ClassVar[Mapping[str, str]] = {"gains": "the law default; this one has vehicle"}

    def _make_law(self, config: ControlConfig) -> VehicleController:
        return VehicleController(self._loaded.model, config.vehicle)

    @property
    def vehicle(self) -> VehicleController:
        """The vehicle's law."""
        law: VehicleController = self._law
        return law

    def prepare(self, period: float) -> None:
        """Check the slopes near the reference for a control period in s, with the arm stowed.

        The law cancels righting moment and drag, so that they are not in its loop.

        Raises:
            ControlSetupError: the loop would not be stable with them.
        """
        law, stowed = self.vehicle.law, dict(postures(self._vehicle))[STOWED]
        axes = [
            each and replace(each, righting=0.0, drag=0.0)
            for each in vehicle_axes(self._vehicle, stowed, Timing(period))
        ]
        check_slopes(
            axes,
            Gains("control.vehicle.k_error", law.k_error, law.stiffness),
            Gains("control.vehicle.k_rate", law.k_rate, law.damping),
        )
        controlled = self._axes.is_controlled
        self._monitor = StabilityMonitor(law.stiffness * controlled, law.damping * controlled)
        self.arm.prepare(period)

    def _vehicle_share(
        self,
        odometry: Odometry,
        q: Array,
        acts: Array,
        planned: Array,
        desired: ReferenceSample,
        dt: float,
    ) -> tuple[Array, Array, Array]:
        """Mass matrix, reference acceleration (6,) and wrench (6,); `stability` is renewed."""
        model, nothing = self._loaded.model, np.zeros(6)
        mass = mass_matrix(model, q)
        inertia = np.ascontiguousarray(mass[:6, :6])
        tracking = tracking_error(odometry, desired)
        fed = acts if self._config.observer else nothing
        wrench = self.vehicle.step(odometry, inertia, fed, tracking, dt)
        if self._monitor is NO_MONITOR:
            return mass, tracking.acceleration, wrench
        needed = inertia @ tracking.acceleration + hull_bias_wrench(model, odometry.nu) - acts
        self.stability = self._monitor.at(
            odometry.stamp, tracking.error, tracking.rate, inertia, needed, wrench - self._lacking
        )
        return mass, tracking.acceleration, wrench
