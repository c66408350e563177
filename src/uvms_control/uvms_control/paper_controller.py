"""Control law `paper`: the vehicle by eq. (22) as printed, the arm by eq. (19)."""

from uvms_control.config import ControlConfig
from uvms_control.controller import Controller
from uvms_control.reference import ReferenceSample
from uvms_control.stability import StabilityMonitor
from uvms_control.tracking_error import TrackingError, tracking_error
from uvms_control.vehicle_controller import VehicleController
from uvms_core.signals import Array, Odometry, Reference
from uvms_core.vehicle import Vehicle


class PaperController(Controller):
    """As `Controller`, with the vehicle's law of the paper; see `VehicleController`.

    It cancels the righting moment of the hull and drives the vehicle with a current: the law to
    compare with, not the one to dive with (docs/control.md).
    """

    def __init__(self, vehicle: Vehicle, config: ControlConfig):
        """`vehicle` from `uvms_core.vehicle.load_vehicle`."""
        super().__init__(vehicle, config)
        self.vehicle = VehicleController(self._model, config.vehicle)
        self._monitor = StabilityMonitor(self.vehicle.law.stiffness, self.vehicle.law.damping)

    def prepare(self, period: float) -> None:
        """Gains of the arm for a control period in s; the vehicle's are configured."""
        self.arm.prepare(period)

    def reset(self) -> None:
        """Return to the state before the first step."""
        super().reset()
        if hasattr(self, "vehicle"):
            self.vehicle.reset()

    def _vehicle_wrench(
        self,
        odometry: Odometry,
        q: Array,
        mass: Array,
        known: Array,
        desired: ReferenceSample,
        reference: Reference,
        dt: float,
    ) -> tuple[TrackingError, Array]:
        """Errors with the reference's acceleration, and the wrench (6,)."""
        tracking = tracking_error(odometry, desired)
        return tracking, self.vehicle.step(odometry, mass, known, tracking, dt)
