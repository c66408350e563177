"""Plots of what a run took from its supply: electrical power, and what the battery has left."""

from functools import partial

from uvms_analysis.energy import battery_series, electrical_power
from uvms_analysis.report.plot import Curve, Limit, Panel, Part, panel, panels
from uvms_analysis.report.run import ReportedRun
from uvms_core.battery import LOW


def electrical(run: ReportedRun) -> list[Panel]:
    """Power of all, of thrusters and of joints; power of each thruster."""
    power = electrical_power(run.truth)

    def each(index: int) -> Curve:
        return power.time, power.thrusters[:, index]

    whole = partial(
        panel, "power_electrical", "electrical power", "W",
        [Part("all", lambda: (power.time, power.total)),
         Part("thrusters", lambda: (power.time, power.thrusters.sum(axis=1)), "thin"),
         Part("joints", lambda: (power.time, power.arm), "thin")], least=1.0, peaks=True,
    )  # fmt: skip
    return panels([
        whole,
        *(partial(panel, f"power_electrical_{name}", f"electrical power of {name}", "W",
                  [Part("power", partial(each, index))], least=1.0, peaks=True)
          for index, name in enumerate(run.log.vehicle.thruster_names)),
    ])  # fmt: skip


def battery(run: ReportedRun) -> list[Panel]:
    """Charge that is left, voltage and current."""
    said = battery_series(run.truth)
    return panels([
        partial(panel, "battery_left", "charge left", "%",
                [Part("left", lambda: (said.time, 100.0 * said.percentage))],
                [Limit("low", 100.0 * LOW)], least=0.1),
        partial(panel, "battery_voltage", "voltage", "V",
                [Part("voltage", lambda: (said.time, said.voltage))], least=0.1),
        partial(panel, "battery_current", "current, mean since the sample before; taken: < 0", "A",
                [Part("current", lambda: (said.time, said.current))], least=0.1),
    ])  # fmt: skip
