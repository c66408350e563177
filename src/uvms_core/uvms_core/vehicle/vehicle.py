"""The whole vehicle as its file describes it."""

from pydantic import Field, field_validator, model_validator

from uvms_core.vehicle.arm import Arm
from uvms_core.vehicle.electrical import Battery, Electrical
from uvms_core.vehicle.environment import Environment
from uvms_core.vehicle.hull import Hull
from uvms_core.vehicle.parts import Part, unique_names
from uvms_core.vehicle.sensors import Sensors
from uvms_core.vehicle.tether import Tether
from uvms_core.vehicle.thrusters import Thruster


class Vehicle(Part):
    """Vehicle, arm, actuators, sensors and the water around them; mirrors the YAML file.

    Made by `load_vehicle`, which replaces the file's keywords by values.
    """

    name: str = Field(min_length=1, description="name of the vehicle")
    environment: Environment = Field(description="water, gravity and geographic datum")
    hull: Hull = Field(description="the vehicle without its arm")
    thrusters: tuple[Thruster, ...] = Field(min_length=1, description="thrusters, any number")
    arm: Arm = Field(description="arm, a serial chain of revolute joints")
    sensors: Sensors = Field(description="rates, lever arms, noise")
    tether: Tether | None = Field(
        default=None,
        description="pull of a tether by depth, which the plant adds and no controller knows of;"
        " none: no tether",
    )
    electrical: Electrical | None = Field(
        default=None,
        description="battery and loads, from which the plant and the report work out the energy of"
        " a run, with `power` of the thrusters; none: not given",
    )

    @field_validator("thrusters")
    @classmethod
    def _named_once(cls, value: tuple[Thruster, ...]) -> tuple[Thruster, ...]:
        unique_names(value, "thruster")
        return value

    @model_validator(mode="after")
    def _sensors_suit_the_site(self) -> "Vehicle":
        for name, section in self.sensors.mounted.items():
            try:
                section.check_site(self.environment)
            except ValueError as fault:
                raise ValueError(f"sensors.{name}: {fault}") from fault
        return self

    @property
    def lacks_power(self) -> str:
        """Why the electrical power of a motion is not known; empty where it is."""
        if self.electrical is None:
            return "the vehicle file has no section `electrical`"
        lacking = [thruster.name for thruster in self.thrusters if thruster.power is None]
        if lacking:
            return f"the vehicle file gives no `power` of {', '.join(lacking)}"
        return ""

    @property
    def battery(self) -> Battery | None:
        """The battery, where it is known what is taken from it."""
        if self.electrical is None or self.lacks_power:
            return None
        return self.electrical.battery

    @property
    def n_joints(self) -> int:
        """Number of joints of the arm."""
        return len(self.arm.joints)

    @property
    def n_thrusters(self) -> int:
        """Number of thrusters."""
        return len(self.thrusters)

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints, from the base to the tool."""
        return tuple(joint.name for joint in self.arm.joints)

    @property
    def thruster_names(self) -> tuple[str, ...]:
        """Names of the thrusters, in the order of thrust vectors."""
        return tuple(thruster.name for thruster in self.thrusters)
