"""Finds what is wrong with a campaign before anything runs."""

import hashlib
import sys
import time
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, get_args

from uvms_analysis.flat import flatten
from uvms_analysis.log.memory import MemoryWriter
from uvms_analysis.log.run_end import RunEnd
from uvms_analysis.outcome import ESTIMATES, TRUTH, Word
from uvms_analysis.summary import summarise
from uvms_bringup.campaign.bound import OUTCOME, Bound
from uvms_bringup.campaign.draw import Draw
from uvms_bringup.campaign.plan import Run, Variant
from uvms_bringup.campaign.progress import LINE_S
from uvms_bringup.campaign.row import RAISED
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
        CampaignError: a setting, a value that may be drawn, or a requirement is not there or not
            allowed; names the case, and what is allowed.
    """
    fields: Mapping[str, Any] = {}
    digests = {}
    drawn: set[str] = set()
    progress = _Progress()
    for one in chosen:
        what = f"campaign {campaign}: case {one.case!r}"
        try:
            run = one.run(one.seeds[0])
            scenario, own, vehicle = _loaded(run)
        except UvmsError as fault:
            raise CampaignError(f"{what}: {fault}") from fault
        digests[one.case] = _digest(scenario, vehicle)
        fields = fields or summary_fields(own, vehicle)
        for name, bound in one.required.items():
            if why := requirement_fault(name, bound, fields):
                raise CampaignError(f"{what}: require: {why}")
        if one.draws and not one.baseline_of and (key := _key(one)) not in drawn:
            drawn.add(key)
            _check_draws(what, one.draws, run)
        progress.show(len(digests))
    return digests


def _loaded(run: Run) -> tuple[Scenario, Scenario, Vehicle]:
    """A run's scenario, the same for its vehicle, and the vehicle.

    Raises:
        UvmsError: a value is not allowed.
    """
    scenario = run.load()
    vehicle = scenario.load_vehicle()
    own = scenario.for_vehicle(vehicle)
    own.build_goals(vehicle)
    return scenario, own, vehicle


def _key(one: Variant) -> str:
    """The same for all points of a grid: the ends of its draws are checked at the first."""
    return repr((one.scenario, one.vehicle, one.values, one.draws))


def _check_draws(what: str, draws: Mapping[str, Draw], run: Run) -> None:
    """Raise CampaignError where a value that may be drawn is not allowed: the ends, one by one."""
    for path, draw in draws.items():
        for word, value in draw.ends():
            try:
                _loaded(replace(run, values={**run.values, path: value}))
            except UvmsError as fault:
                raise CampaignError(
                    f"{what}: draw: {path}: {word} is {value}, which is not allowed: {fault}"
                ) from fault


class _Progress:
    """Says every few seconds how far the check is, where it takes that long."""

    def __init__(self) -> None:
        self._shown = time.monotonic()

    def show(self, count: int) -> None:
        """So many are checked."""
        if time.monotonic() - self._shown >= LINE_S:
            self._shown = time.monotonic()
            print(f"{count:6d} cases and combinations checked", file=sys.stderr, flush=True)


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


def requirement_fault(name: str, bound: Bound, fields: Mapping[str, Any]) -> str:
    """Why no run can be judged by a bound; empty where it can be."""
    if not _is_field(name, fields):
        return f"{name!r} is no field of a summary; choose from {', '.join(sorted(fields))}"
    known = fields.get(name)
    wanted = [bound.equals] if "equals" in bound.model_fields_set else []
    wanted += bound.one_of or ()
    if bound.is_numeric and isinstance(known, str | bool | list):
        return (
            f"{name}: min and max are for numbers, and this is {_kind(known)}; use equals, one_of"
        )
    choices = CHOICES.get(name)
    if choices is not None:
        wrong = [one for one in wanted if one not in choices]
        return f"{name}: {wrong[0]!r}: choose from {', '.join(choices)}" if wrong else ""
    for one in wanted:
        if known is not None and one is not None and _kind(one) != _kind(known):
            return f"{name}: {one!r} is {_kind(one)}, and the field is {_kind(known)}"
    return ""


def _kind(value: Any) -> str:
    if isinstance(value, bool):
        return "true or false"
    if isinstance(value, int | float):
        return "a number"
    return "a text" if isinstance(value, str) else "a list"


CHOICES: dict[str, tuple[str, ...]] = {
    OUTCOME: (*get_args(Word), RAISED),
    "judged_by": (TRUTH, ESTIMATES),
}
"""Words that a field of a summary may be."""


def _is_field(name: str, fields: Mapping[str, Any]) -> bool:
    """Whether a summary has the field, or one of its parents depends on the run."""
    parts = name.split(".")
    parents = (".".join(parts[:k]) for k in range(1, len(parts)))
    return name in fields or any(p in fields and fields[p] is None for p in parents)
