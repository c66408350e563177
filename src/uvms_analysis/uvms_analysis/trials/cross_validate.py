"""How well the model predicts trials that its constants were not fitted to."""

from collections.abc import Callable, Sequence
from typing import Any

from uvms_analysis.trials.fit import Fit, fit, group_of
from uvms_analysis.trials.identify import Identified, Log
from uvms_analysis.trials.parameters import changed
from uvms_analysis.trials.predict import PreparedTrial, drive_model, dynamic
from uvms_analysis.trials.score import Score, medians, scores
from uvms_core.vehicle import vehicle_from_data


def cross_validated(found: Identified, prepared: Sequence[PreparedTrial], log: Log) -> str:
    """Medians over the trials, each predicted by a fit without it and without its motion."""
    lines = []
    for what, key in (("trial", lambda name: name), ("motion", group_of)):
        roll, pitch = medians(left_out(found.data, prepared, found.fit, key, log))
        lines.append(
            f"fitted without the {what} that is scored, median of {len(prepared)}:"
            f" roll {roll.rmse:.3f} deg, pitch {pitch.rmse:.3f} deg"
        )
    return "\n".join(lines)


def left_out(
    data: Any, prepared: Sequence[PreparedTrial], full: Fit, key: Callable[[str], str], log: Log
) -> list[tuple[Score, Score]]:
    """Scores of each trial by a fit to the trials of other keys, starting from the full fit."""
    data = changed(
        data, {p.path: float(v) for p, v in zip(full.parameters, full.values, strict=True)}
    )
    found: dict[str, tuple[Score, Score]] = {}
    for out in sorted({key(each.trial.name) for each in prepared}):
        log(f"without {out}")
        rest = [each for each in prepared if key(each.trial.name) != out]
        part = fit(data, rest, full.parameters)
        new = changed(
            data, {p.path: float(v) for p, v in zip(part.parameters, part.values, strict=True)}
        )
        model, load = drive_model(vehicle_from_data(new))
        for each in prepared:
            if key(each.trial.name) == out:
                predicted = dynamic(each, model, load)
                found[each.trial.name] = scores(each.trial, predicted.tilt)
    return [found[each.trial.name] for each in prepared]
