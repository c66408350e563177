"""The campaign file: which scenarios are run, with which values and seeds, and what they must keep.

Every setting is a path of the scenario as in `--set PATH=VALUE`; `vehicle.…` leads into the
vehicle file.
"""

import re
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, field_validator, model_validator

from uvms_bringup.campaign.bound import Bound
from uvms_bringup.campaign.draw import Draw
from uvms_bringup.errors import CampaignError
from uvms_bringup.locate import known_campaigns
from uvms_core.config import Config, validated
from uvms_core.vehicle.locate import FILE_SUFFIXES
from uvms_core.yaml_text import parse_yaml, read_yaml

CAMPAIGN_FILE = "campaign.yaml"
"""The copy of a campaign in its folder of results."""

MOST_RUNS = 100_000
"""A day of one-second runs on one core; each is also an object in memory and a row of the page."""
NAME = re.compile(r"[A-Za-z0-9_][\w .+=-]*")
"""A name becomes part of a folder's name; the signs / [ ] and , have a meaning in a row's name."""

LARGEST_SEED = 2**63 - 1
Seed = Annotated[int, Field(strict=True, ge=0, le=LARGEST_SEED)]
Settings = dict[str, Any]
Seeds = (
    Annotated[int, Field(strict=True, ge=1, le=MOST_RUNS)]
    | Annotated[tuple[Seed, ...], Field(min_length=1)]
)
Variation = (
    Annotated[tuple[Any, ...], Field(min_length=1)] | Annotated[dict[str, Any], Field(min_length=1)]
)

RESERVED = {
    "seed": "seeds are given by `seeds`",
    "scenario": "write `scenario` in the case itself",
    "vehicle": "write `vehicle` in the case itself",
}


class Case(Config):
    """A named situation; what it does not give is the campaign's own."""

    scenario: str | None = Field(None, description="name or file of the scenario")
    vehicle: str | None = Field(None, description="name or file of the vehicle")
    set: Settings = Field(
        default_factory=dict, description="values by path, after those of the campaign"
    )
    events: tuple[Any, ...] | None = Field(
        None, description="events of the run, in the place of the scenario's"
    )
    vary: dict[str, Variation] = Field(
        default_factory=dict,
        description="values to try by path, as a list or by name; every combination is run",
    )
    draw: dict[str, Draw] = Field(
        default_factory=dict, description="distributions by path, drawn from by the run's seed"
    )
    require: dict[str, Bound | None] = Field(
        default_factory=dict,
        description="bounds by dotted field of the summary, in the place of the campaign's of that"
        " field; null lifts the campaign's",
    )
    baselines: dict[str, Settings | None] = Field(
        default_factory=dict,
        description="settings by name that every run of the case is repeated with for comparison;"
        " null lifts the campaign's of that name",
    )
    seeds: Seeds | None = Field(None, description="number of seeds (1, 2, ...), or a list of them")

    @field_validator("seeds", mode="before")
    @classmethod
    def _are_seeds(cls, given: Any) -> Any:
        """One clear message, where pydantic has one for each kind of value."""
        many = given if isinstance(given, list | tuple) else [given]
        least = 0 if isinstance(given, list | tuple) else 1
        good = all(type(one) is int and one >= least for one in many)
        if given is not None and not (good and many and len(set(many)) == len(many)):
            raise ValueError("write how many seeds (>= 1), or a list of seeds (>= 0), each once")
        if type(given) is int and given > MOST_RUNS:
            raise ValueError(f"{given:,} seeds; a campaign has at most {MOST_RUNS:,} runs")
        if isinstance(given, list | tuple) and max(given) > LARGEST_SEED:
            raise ValueError(f"a seed is at most {LARGEST_SEED}")
        return given

    @field_validator("vary", mode="before")
    @classmethod
    def _varies(cls, given: Any) -> Any:
        """One clear message, where pydantic has one for each way to write the values."""
        for path, values in _mapping(given, "PATH: [VALUE, VALUE]").items():
            if not isinstance(values, list | tuple | dict) or not values:
                raise ValueError(
                    f"{path!r}: write the values to try, as [VALUE, VALUE] or {{NAME: VALUE}}"
                )
        return given

    @field_validator("require", mode="before")
    @classmethod
    def _requires(cls, given: Any) -> Any:
        for name, bound in _mapping(given, "FIELD: {max: VALUE}").items():
            if not isinstance(bound, dict | Bound | None):
                raise ValueError(
                    f"{name!r}: write a bound as {{max: {_shown(bound)}}}, with one or more of"
                    f" {', '.join(Bound.model_fields)}; null lifts the campaign's"
                )
        return given

    @field_validator("events", mode="before")
    @classmethod
    def _are_events(cls, given: Any) -> Any:
        if given is not None and not isinstance(given, list | tuple):
            raise ValueError("write a list of events; [] for none")
        return given

    @field_validator("set", "vary", "draw")
    @classmethod
    def _leaves_the_rest(cls, values: dict[str, Any]) -> dict[str, Any]:
        for path in values:
            if path in RESERVED:
                raise ValueError(f"{path!r}: {RESERVED[path]}")
        return values

    @field_validator("baselines")
    @classmethod
    def _have_names(cls, values: dict[str, Any]) -> dict[str, Any]:
        return _named(values)

    @model_validator(mode="after")
    def _no_path_twice(self) -> "Case":
        if both := sorted(self.vary.keys() & self.draw.keys()):
            raise ValueError(f"{both[0]!r} is both varied and drawn; keep one of them")
        return self


class Campaign(Case):
    """Many runs; `cases` empty: one case, `run`, with the campaign's own values."""

    campaign: str = Field(description="name of the campaign; by default that of its file")
    description: str = Field("", description="one sentence for the page of results")
    seeds: Seeds = Field(1, description="number of seeds (1, 2, ...), or a list of them")
    cases: dict[str, Case] = Field(default_factory=dict, description="cases by name")

    @field_validator("campaign")
    @classmethod
    def _names_a_folder(cls, name: str) -> str:
        return next(iter(_named({name: None})))

    @field_validator("cases")
    @classmethod
    def _cases_have_names(cls, values: dict[str, Any]) -> dict[str, Any]:
        return _named(values)

    @model_validator(mode="after")
    def _has_scenarios(self) -> "Campaign":
        for name, case in (self.cases or {"run": self}).items():
            if case.scenario is None and self.scenario is None:
                raise ValueError(f"case {name!r} has no scenario, and the campaign has none either")
        return self


def _mapping(given: Any, example: str) -> dict[Any, Any]:
    """The values by name; ValueError where it is no mapping."""
    if not isinstance(given, dict):
        raise ValueError(f"write a mapping, such as {{{example}}}")
    return given


def _shown(value: Any) -> str:
    """A number as a message repeats it in an example; else a word for it."""
    return f"{value:g}" if isinstance(value, int | float) else "VALUE"


def _named(values: dict[str, Any]) -> dict[str, Any]:
    for name in values:
        if not NAME.fullmatch(name):
            raise ValueError(
                f"{name!r}: start a name with a letter or digit, then use letters, digits, spaces"
                " and the signs _ . + = -"
            )
    return values


def load_campaign(name: str) -> Campaign:
    """The campaign of that name or file; paths of scenario and vehicle files become absolute.

    Raises:
        CampaignError: it does not exist, or a value is not allowed; the message says which and why.
    """
    path = _campaign_path(name)
    return _campaign(read_yaml(path, f"campaign {path}", CampaignError), path)


def read_campaign(text: str, path: Path) -> Campaign:
    """The campaign of a text that was read from `path`; raises as `load_campaign`."""
    return _campaign(parse_yaml(text, f"campaign {path}", CampaignError), path)


def _campaign(data: Any, path: Path) -> Campaign:
    if not isinstance(data, dict):
        raise CampaignError(f"campaign {path}: a campaign is a mapping of names to values")
    data.setdefault("campaign", path.stem)
    cases = data.get("cases")
    for group in (data, *(cases.values() if isinstance(cases, dict) else ())):
        _make_absolute(group, path.parent)
    # A case without values of its own may be written as `nominal:`.
    if isinstance(cases, dict):
        data["cases"] = {name: {} if case is None else case for name, case in cases.items()}
    return validated(Campaign, data, f"campaign {path.name}", CampaignError)


def _campaign_path(name: str) -> Path:
    path = Path(name)
    if path.suffix in FILE_SUFFIXES:
        if path.is_file():
            return path
        raise CampaignError(f"campaign file {name!r} does not exist")
    known = known_campaigns()
    if name not in known:
        choices = ", ".join(known) or "(none)"
        raise CampaignError(f"unknown campaign {name!r}; choose one of {choices}, or a YAML file")
    return known[name]


def _make_absolute(group: Any, folder: Path) -> None:
    for name in ("scenario", "vehicle"):
        value = group.get(name) if isinstance(group, dict) else None
        if isinstance(value, str) and value.endswith(FILE_SUFFIXES):
            group[name] = str((folder / value).resolve())
