"""Does a vehicle make sense? Checks of its values against physics and against one another.

A file can be complete and well-formed and still describe nothing that floats: a volume in litres, a
mass in grams, angles in radians. What is impossible for any vehicle is an error, and `load_vehicle`
refuses it; what is odd is a warning, which a vehicle may be on purpose. Each check states a reason
and a bound; bounds are ratios wherever they can be, so that they fit vehicles of 200 g and of 20 t.
"""

from uvms_core.vehicle.plausible.angles import check_angles
from uvms_core.vehicle.plausible.bodies import check_added_mass, check_bodies
from uvms_core.vehicle.plausible.dissipation import check_dissipation
from uvms_core.vehicle.plausible.drives import check_drives
from uvms_core.vehicle.plausible.energy import check_energy
from uvms_core.vehicle.plausible.finding import Finding
from uvms_core.vehicle.plausible.instruments import check_instruments
from uvms_core.vehicle.plausible.mounting import check_mounting
from uvms_core.vehicle.plausible.propulsion import check_propulsion
from uvms_core.vehicle.plausible.stability import check_stability
from uvms_core.vehicle.plausible.water import check_water
from uvms_core.vehicle.vehicle import Vehicle

__all__ = ["Finding", "implausible", "vehicle_findings", "vehicle_warnings"]

_CHECKS = (
    check_water,
    check_bodies,
    check_angles,
    check_propulsion,
    check_mounting,
    check_dissipation,
)
_ODDITIES = (
    check_added_mass,
    check_stability,
    check_instruments,
    check_drives,
    check_energy,
)  # find warnings only


def vehicle_findings(vehicle: Vehicle) -> tuple[Finding, ...]:
    """All that is impossible or odd about a vehicle, errors first."""
    found = [finding for check in (*_CHECKS, *_ODDITIES) for finding in check(vehicle)]
    return tuple(sorted(found, key=lambda finding: not finding.is_error))


def implausible(vehicle: Vehicle) -> tuple[Finding, ...]:
    """Only what is impossible; quicker than all findings."""
    found = (finding for check in _CHECKS for finding in check(vehicle))
    return tuple(finding for finding in found if finding.is_error)


def vehicle_warnings(vehicle: Vehicle) -> tuple[str, ...]:
    """What is odd about a vehicle, a line each: field, value, bound and reason."""
    return tuple(str(each) for each in vehicle_findings(vehicle) if not each.is_error)
