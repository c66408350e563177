"""Finds what is wrong with a campaign before anything runs."""

import hashlib
from collections.abc import Iterable, Mapping
from typing import Any

from uvms_analysis.flat import flatten
from uvms_analysis.log.memory import MemoryWriter
from uvms_analysis.log.run_end import RunEnd
from uvms_analysis.summary import summarise
from uvms_bringup.campaign.plan import Variant
from uvms_bringup.errors import CampaignError
from uvms_bringup.pace import Pace
from uvms_bringup.scenario import Scenario
from uvms_bringup.session import effective_values, run_records
from uvms_core.errors import UvmsError
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.plant.as_built import as_built


def check_variants(campaign: str, chosen: Iterable[Variant]) -> dict[str, str]:
    """Load each variant's scenario with the values of its first seed; returns digests by case.

    A digest tells whether scenario and vehicle are still the same.

    Raises:
        CampaignError: a setting or a required field is not there or not allowed; names the case,
            and what is allowed.
    """
    fields: Mapping[str, Any] = {}
    digests = {}
    for one in chosen:
        what = f"campaign {campaign}: case {one.case!r}"
        try:
            scenario = one.run(one.seeds[0]).load()
            vehicle = scenario.load_vehicle()
            own = scenario.for_vehicle(vehicle)
            own.goal.build(vehicle, own.plant)
        except UvmsError as fault:
            raise CampaignError(f"{what}: {fault}") from fault
        digests[one.case] = _digest(scenario, vehicle)
        fields = fields or summary_fields(own, vehicle)
        for name in one.required:
            if not _is_field(name, fields):
                known = ", ".join(sorted(fields))
                raise CampaignError(
                    f"{what}: require: {name!r} is no field of a summary; choose from {known}"
                )
    return digests


def _digest(scenario: Scenario, vehicle: Vehicle) -> str:
    """Scenario and vehicle in 16 digits."""
    text = f"{scenario.model_dump_json()}\n{vehicle.model_dump_json()}"
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def summary_fields(scenario: Scenario, vehicle: Vehicle) -> dict[str, Any]:
    """The fields of a summary by dotted name, as a run has them in which nothing happened.

    Those that depend on the run, such as counts by node, are one field here, which is None.
    """
    built = as_built(vehicle, scenario.plant, scenario.seed)
    log = MemoryWriter(vehicle, ()).log(
        run_records(scenario, built, str(Pace())), effective_values(scenario), None, RunEnd(0.0)
    )
    return flatten(_without_empty_groups(summarise(log, wall_s=None)))


def _without_empty_groups(values: Mapping[str, Any]) -> dict[str, Any]:
    return {
        key: (_without_empty_groups(value) or None) if isinstance(value, Mapping) else value
        for key, value in values.items()
        if key != "missing"
    }


def _is_field(name: str, fields: Mapping[str, Any]) -> bool:
    """Whether a summary has the field, or one of its parents depends on the run."""
    parts = name.split(".")
    parents = (".".join(parts[:k]) for k in range(1, len(parts)))
    return name in fields or any(p in fields and fields[p] is None for p in parents)
