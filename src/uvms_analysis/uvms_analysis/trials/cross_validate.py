"""How well the model predicts trials that its constants were not fitted to."""

from collections.abc import Callable, Sequence
from typing import Any

from uvms_analysis.trials.fit import Fit, fit, group_of
from uvms_analysis.trials.identify import Identified, Tell
from uvms_analysis.trials.parameters import changed
from uvms_analysis.trials.predict import Course, drive_model, dynamic
from uvms_analysis.trials.score import Score, medians, scores
from uvms_core.vehicle import vehicle_from_data


def cross_validated(found: Identified, courses: Sequence[Course], tell: Tell) -> str:
    """Medians over the trials, each predicted by a fit without it and without its motion."""
    lines = []
    for what, key in (("trial", lambda name: name), ("motion", group_of)):
        roll, pitch = medians(left_out(found.data, courses, found.fit, key, tell))
        lines.append(
            f"fitted without the {what} that is scored, median of {len(courses)}:"
            f" roll {roll.rmse:.3f} deg, pitch {pitch.rmse:.3f} deg"
        )
    return "\n".join(lines)


def left_out(
    data: Any, courses: Sequence[Course], full: Fit, key: Callable[[str], str], tell: Tell
) -> list[tuple[Score, Score]]:
    """Scores of each course by a fit to those of other keys, begun at the full fit."""
    data = changed(
        data, {p.path: float(v) for p, v in zip(full.parameters, full.values, strict=True)}
    )
    found: dict[str, tuple[Score, Score]] = {}
    for out in sorted({key(course.trial.name) for course in courses}):
        tell(f"without {out}")
        rest = [course for course in courses if key(course.trial.name) != out]
        part = fit(data, rest, full.parameters)
        new = changed(
            data, {p.path: float(v) for p, v in zip(part.parameters, part.values, strict=True)}
        )
        model, load = drive_model(vehicle_from_data(new))
        for course in courses:
            if key(course.trial.name) == out:
                said = dynamic(course, model, load)
                found[course.trial.name] = scores(course.trial, said.tilt)
    return [found[course.trial.name] for course in courses]
