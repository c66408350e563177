"""The runs of a campaign: cases x grid x baselines x seeds, in a fixed order."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from itertools import product
from math import prod
from typing import Any

from uvms_bringup.campaign.bound import OUTCOME, Bound
from uvms_bringup.campaign.draw import Draw
from uvms_bringup.campaign.file import MOST_RUNS, Campaign, Case
from uvms_bringup.errors import CampaignError
from uvms_bringup.scenario import Scenario, load_scenario

ONLY_CASE = "run"
"""Name of the case of a campaign that has none."""


@dataclass(frozen=True)
class Run:
    """One run of a campaign.

    Args:
        case: name of its row: the case, `[PATH=VALUE]` where something is varied, `/BASELINE`.
        baseline_of: name of the case whose baseline it is; "" where it is none.
        scenario, vehicle: name or file; None: the scenario's own vehicle.
        values: settings by path, in the order in which they are applied.
        chosen: of these, what was varied or drawn.
        required: bounds by field of the summary.
    """

    case: str
    baseline_of: str
    seed: int
    scenario: str
    vehicle: str | None
    values: Mapping[str, Any]
    chosen: Mapping[str, Any]
    required: Mapping[str, Bound]

    @property
    def key(self) -> tuple[str, int]:
        """What tells it from the others."""
        return self.case, self.seed

    def load(self) -> Scenario:
        """Its scenario.

        Raises:
            ScenarioError: a value is not allowed.
        """
        return load_scenario(
            self.scenario, values=self.values, seed=self.seed, vehicle=self.vehicle
        )


@dataclass(frozen=True)
class Variant:
    """A case at one point of its grid, with the settings of one baseline or of none."""

    case: str
    baseline_of: str
    scenario: str
    vehicle: str | None
    values: Mapping[str, Any]
    varied: Mapping[str, Any]
    draws: Mapping[str, Draw]
    baseline: Mapping[str, Any]
    required: Mapping[str, Bound]
    seeds: tuple[int, ...]

    def run(self, seed: int) -> Run:
        """The run of a seed."""
        drawn = {path: draw.value(path, seed) for path, draw in self.draws.items()}
        chosen = {**self.varied, **drawn}
        values = {**self.values, **chosen, **self.baseline}
        return Run(
            self.case, self.baseline_of, seed, self.scenario, self.vehicle, values, chosen,
            self.required,
        )  # fmt: skip


def variants(campaign: Campaign, pattern: str = "*") -> tuple[Variant, ...]:
    """What is run with every seed, in the order of the file; each is followed by its baselines.

    Args:
        pattern: shell pattern (`*`, `?`) of the names that are wanted; those of baselines are
            taken with the case whose baselines they are.

    Raises:
        CampaignError: no name fits the pattern, or there are too many runs.
    """
    _check_count(campaign)
    everything = [
        one
        for name, case in (campaign.cases or {ONLY_CASE: Case()}).items()
        for one in _of_case(campaign, name, case)
    ]
    chosen = tuple(one for one in everything if _fits(one, pattern))
    if not chosen:
        names = ", ".join(one.case for one in everything if not one.baseline_of)
        raise CampaignError(f"--select {pattern!r}: fits none of {names}")
    return chosen


def _check_count(campaign: Campaign) -> None:
    """Raise CampaignError where there are too many runs, before any is made; says what multiplies.

    The whole campaign counts, whatever is selected of it: its names alone would take minutes.
    """
    total, most, words = 0, 0, ""
    for name, case in (campaign.cases or {ONLY_CASE: Case()}).items():
        factors = {f"{len(values)} of {path}": len(values) for path, values in
                   _grid(campaign, case).items()}  # fmt: skip
        seeds = len(_seeds(campaign, case))
        factors[f"{seeds:,} {'seed' if seeds == 1 else 'seeds'}"] = seeds
        if baselines := len(_baselines(campaign, case)):
            factors[f"{1 + baselines} (1 and {baselines} baselines)"] = 1 + baselines
        count = prod(factors.values())
        total += count
        if count > most:
            most, words = count, f"case {name!r} alone: {count:,} = {' x '.join(factors)}"
    if total > MOST_RUNS:
        raise CampaignError(
            f"campaign {campaign.campaign}: {total:,} runs, and at most {MOST_RUNS:,} are allowed"
            f" ({words}); vary fewer values, or draw them by seed instead of varying them"
        )


def runs(chosen: tuple[Variant, ...]) -> Iterator[Run]:
    """Every run, seed by seed within a variant."""
    for one in chosen:
        for seed in one.seeds:
            yield one.run(seed)


def find_run(campaign: Campaign, case: str, seed: int) -> Run:
    """The run of a row.

    Raises:
        CampaignError: there is none; says what there is.
    """
    everything = variants(campaign)
    found = next((one for one in everything if one.case == case), None)
    if found is None:
        names = ", ".join(one.case for one in everything)
        raise CampaignError(f"campaign {campaign.campaign} has no case {case!r}; it has {names}")
    if seed not in found.seeds:
        seeds = ", ".join(map(str, found.seeds))
        raise CampaignError(f"case {case!r} has no seed {seed}; it has {seeds}")
    return found.run(seed)


def _fits(one: Variant, pattern: str) -> bool:
    # `[` has a meaning in shell patterns, and stands in the names of varied cases.
    literal = pattern.replace("[", "[[]")
    return any(fnmatchcase(name, literal) for name in (one.case, one.baseline_of) if name)


def _of_case(campaign: Campaign, name: str, case: Case) -> Iterator[Variant]:
    own = _own(case)
    draws = {**{k: v for k, v in campaign.draw.items() if k not in own}, **case.draw}
    values = {**campaign.set, **case.set}
    events = case.events if case.events is not None else campaign.events
    if events is not None:
        values["events"] = list(events)
    for varied, label in _points(_grid(campaign, case)):
        full = f"{name}{label}"
        for baseline, changes in {"": {}, **_baselines(campaign, case)}.items():
            yield Variant(
                case=f"{full}/{baseline}" if baseline else full,
                baseline_of=full if baseline else "",
                scenario=case.scenario or campaign.scenario or "",
                vehicle=case.vehicle or campaign.vehicle,
                values=values,
                varied=varied,
                draws=draws,
                baseline=changes,
                required=_required(campaign, case),
                seeds=_seeds(campaign, case),
            )


def _own(case: Case) -> set[str]:
    """Paths that a case says itself, which goes before the campaign."""
    return {*case.set, *case.vary, *case.draw}


def _grid(campaign: Campaign, case: Case) -> dict[str, Any]:
    own = _own(case)
    return {**{k: v for k, v in campaign.vary.items() if k not in own}, **case.vary}


def _seeds(campaign: Campaign, case: Case) -> tuple[int, ...]:
    seeds = campaign.seeds if case.seeds is None else case.seeds
    return tuple(range(1, seeds + 1)) if isinstance(seeds, int) else seeds


def _points(grid: Mapping[str, Any]) -> Iterator[tuple[dict[str, Any], str]]:
    """Values by path at every point of a grid, and the words for it in a name."""
    axes = [list(_named(values).items()) for values in grid.values()]
    for point in product(*axes):
        words = [f"{path}={word}" for path, (word, _) in zip(grid, point, strict=True)]
        values = {path: value for path, (_, value) in zip(grid, point, strict=True)}
        yield values, f"[{', '.join(words)}]" if words else ""


def _named(values: Any) -> dict[str, Any]:
    if isinstance(values, Mapping):
        return dict(values)
    return {
        one if isinstance(one, str) else json.dumps(one, separators=(",", ":")): one
        for one in values
    }


def _baselines(campaign: Campaign, case: Case) -> dict[str, Mapping[str, Any]]:
    merged = {**campaign.baselines, **case.baselines}
    return {name: changes for name, changes in merged.items() if changes is not None}


def _required(campaign: Campaign, case: Case) -> dict[str, Bound]:
    merged = {OUTCOME: Bound(equals="completed"), **campaign.require, **case.require}
    return {name: bound for name, bound in merged.items() if bound is not None}
