"""What the vehicle runs on: its battery, and what takes power from it besides the thrusters."""

from pydantic import Field, model_validator

from uvms_core.vehicle.parts import Part


class Battery(Part):
    """A battery that gives the charge it has, at a voltage that falls with it and under load.

    The open-circuit voltage U is linear in the charge that is left, from `full_voltage_v` to
    `empty_voltage_v`; without these it is `nominal_voltage_v` throughout. Temperature, rate and age
    do not change the capacity.
    """

    nominal_voltage_v: float = Field(gt=0.0, description="nominal voltage, V")
    capacity_ah: float | None = Field(
        default=None, gt=0.0, description="charge that it gives from full to empty, Ah"
    )
    capacity_wh: float | None = Field(
        default=None,
        gt=0.0,
        description="instead of `capacity_ah`: that charge times the nominal voltage, Wh",
    )
    full_voltage_v: float | None = Field(
        default=None, gt=0.0, description="voltage without a load when full, V; none: nominal"
    )
    empty_voltage_v: float | None = Field(
        default=None, gt=0.0, description="voltage without a load when empty, V; none: nominal"
    )
    internal_resistance_ohm: float = Field(
        default=0.0, ge=0.0, description="resistance of cells and cables, ohm"
    )

    @model_validator(mode="after")
    def _check(self) -> "Battery":
        if (self.capacity_ah is None) == (self.capacity_wh is None):
            raise ValueError("needs capacity_ah or capacity_wh, one of them")
        full, empty = self.voltages_v
        if not empty <= self.nominal_voltage_v <= full:
            raise ValueError(
                f"nominal_voltage_v: {self.nominal_voltage_v:g} V; must be within empty_voltage_v"
                f" = {empty:g} and full_voltage_v = {full:g} V"
            )
        return self

    @property
    def charge_ah(self) -> float:
        """Charge that it gives from full to empty, Ah."""
        if self.capacity_ah is not None:
            return self.capacity_ah
        assert self.capacity_wh is not None  # the validator holds it
        return self.capacity_wh / self.nominal_voltage_v

    @property
    def energy_wh(self) -> float:
        """Its charge at the nominal voltage, Wh."""
        return self.charge_ah * self.nominal_voltage_v

    @property
    def voltages_v(self) -> tuple[float, float]:
        """Voltage without a load when full and when empty, V."""
        nominal = self.nominal_voltage_v
        full, empty = self.full_voltage_v, self.empty_voltage_v
        return nominal if full is None else full, nominal if empty is None else empty


class Electrical(Part):
    """The electrical side of the vehicle. Its thrusters have their own field `power`."""

    hotel_load_w: float = Field(
        ge=0.0,
        description="power that computers, sensors and the drives at rest take all the time, W",
    )
    arm_efficiency: float = Field(
        default=1.0,
        gt=0.0,
        le=1.0,
        description="mechanical power of the joints' drives over their electrical power, 0 to 1;"
        " 1: no losses. Braking gives nothing back",
    )
    battery: Battery | None = Field(
        default=None, description="what all power comes from; none: a tether, or not given"
    )
