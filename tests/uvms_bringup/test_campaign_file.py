"""Campaign files: what they expand to, and what they are refused for, field by field."""

import numpy as np
import pytest
from campaigns import SMALL, write

from uvms_bringup.campaign.bound import Bound, faults
from uvms_bringup.campaign.check import check_variants
from uvms_bringup.campaign.draw import Draw
from uvms_bringup.campaign.file import load_campaign
from uvms_bringup.campaign.plan import find_run, runs, variants
from uvms_bringup.cli import main
from uvms_bringup.errors import CampaignError
from uvms_bringup.locate import known_campaigns


def campaign(tmp_path, text):
    return load_campaign(str(write(tmp_path, text)))


def test_cases_expand_to_grid_baselines_and_seeds_in_the_order_of_the_file(tmp_path):
    made = list(runs(variants(campaign(tmp_path, SMALL))))
    assert [run.key for run in made] == [
        ("still", 1),
        ("still", 2),
        ("still", 3),
        ("still/observer off", 1),
        ("still/observer off", 2),
        ("still/observer off", 3),
        ("current[plant.current_ned_m_s=slow]", 7),
        ("current[plant.current_ned_m_s=slow]", 4),
    ]
    assert [run.baseline_of for run in made] == [""] * 3 + ["still"] * 3 + [""] * 2


def test_every_combination_of_a_grid_is_run(tmp_path):
    text = "scenario: hover\nvary: {a.b: [1, 2], c: {low: 0.5, high: 1.5}}"
    names = [one.case for one in variants(campaign(tmp_path, text))]
    points = ["a.b=1, c=low", "a.b=1, c=high", "a.b=2, c=low", "a.b=2, c=high"]
    assert names == [f"run[{point}]" for point in points]


def test_a_baseline_has_the_seeds_and_draws_of_its_case(tmp_path):
    made = list(runs(variants(campaign(tmp_path, SMALL))))
    for case, beside in zip(made[:3], made[3:6], strict=True):
        assert case.chosen == beside.chosen
        assert beside.values == {**case.values, "control.observer": False}


def test_values_reach_the_scenario_and_the_vehicle(tmp_path):
    run = find_run(campaign(tmp_path, SMALL), "current[plant.current_ned_m_s=slow]", 7)
    scenario = run.load()
    assert (scenario.seed, scenario.duration_s) == (7, 2.0)
    assert scenario.plant.current_ned_m_s == (0.05, 0.05, 0.0)
    drawn = run.chosen["vehicle.hull.cg_m.2"]
    assert scenario.load_vehicle().hull.cg_m[2] == drawn
    assert 0.010 <= drawn <= 0.014


def test_what_a_case_says_itself_goes_before_the_campaign(tmp_path):
    text = """
scenario: hover
set: {duration_s: 2.0, seed_word: 1}
draw: {x: {uniform: [0, 1]}}
vary: {y: [1, 2]}
require: {roll_deg.max: {max: 3.0}, pitch_deg.max: {max: 3.0}}
baselines: {off: {control.observer: false}}
cases:
  own:
    set: {x: 5, y: 6}
    require: {roll_deg.max: {max: 1.0}, pitch_deg.max: null}
    baselines: {off: null}
"""
    (one,) = variants(campaign(tmp_path, text))
    assert one.run(1).values == {"duration_s": 2.0, "seed_word": 1, "x": 5, "y": 6}
    assert list(one.required) == ["outcome", "roll_deg.max"]
    assert one.required["roll_deg.max"].max == 1.0


def test_paths_of_files_are_relative_to_the_campaign(tmp_path):
    (tmp_path / "mine.yaml").write_text("duration_s: 3.0\n")
    made = campaign(tmp_path, "scenario: mine.yaml\ncases: {a: {vehicle: other.yaml}}")
    assert made.scenario == str(tmp_path / "mine.yaml")
    assert made.cases["a"].vehicle == str(tmp_path / "other.yaml")


def test_select_takes_cases_with_their_baselines(tmp_path):
    made = campaign(tmp_path, SMALL)
    assert [one.case for one in variants(made, "st*")] == ["still", "still/observer off"]
    assert [one.case for one in variants(made, "current[*")] == [
        "current[plant.current_ned_m_s=slow]"
    ]
    with pytest.raises(CampaignError, match=r"--select 'gust': fits none of still, current\["):
        variants(made, "gust")


def test_the_outcome_is_required_unless_the_campaign_says_otherwise(tmp_path):
    (one,) = variants(campaign(tmp_path, "scenario: hover"))
    assert faults(one.required, {"outcome": "given up"}) == [
        "outcome is given up, and must be completed"
    ]
    text = "scenario: hover\nrequire: {outcome: {one_of: [completed, given up]}}"
    (other,) = variants(campaign(tmp_path, text))
    assert faults(other.required, {"outcome": "given up"}) == []


@pytest.mark.parametrize(
    ("bound", "value", "fault"),
    [
        ({"max": 3.0}, 3.0, ""),
        ({"max": 3.0}, 3.5, "x is 3.5, and must be <= 3"),
        ({"min": 1, "max": 3}, 0.5, "x is 0.5, and must be >= 1 and <= 3"),
        ({"max": 3.0}, None, "x is not known, and must be <= 3"),
        ({"max": 3.0}, float("nan"), "x is nan, and must be <= 3"),
        ({"equals": 0}, 0, ""),
        ({"equals": 0}, False, "x is False, and must be 0"),
        ({"equals": None}, None, ""),
        ({"one_of": ["a", "b"]}, "c", "x is c, and must be a or b"),
    ],
)
def test_bounds(bound, value, fault):
    assert Bound(**bound).fault("x", value) == fault


def test_draws_have_their_distributions_and_do_not_shift_one_another():
    seeds = range(4000)
    uniform = np.array([Draw(uniform=(2.0, 4.0)).value("a", s) for s in seeds])
    normal = np.array([Draw(normal=(5.0, 0.5)).value("a", s) for s in seeds])
    wide = np.array([Draw(loguniform=(0.1, 10.0)).value("a", s) for s in seeds])
    chosen = [Draw(choice=("x", "y", "z")).value("a", s) for s in seeds]
    # Five standard deviations of a mean of 4000.
    assert uniform.mean() == pytest.approx(3.0, abs=5 * 2 / np.sqrt(12 * 4000))
    assert 2.0 <= uniform.min() < 2.01 < 3.99 < uniform.max() <= 4.0
    assert normal.mean() == pytest.approx(5.0, abs=5 * 0.5 / np.sqrt(4000))
    assert normal.std() == pytest.approx(0.5, rel=5 / np.sqrt(8000))
    assert np.median(wide) == pytest.approx(1.0, rel=0.25)
    assert all(abs(chosen.count(one) / 4000 - 1 / 3) < 0.04 for one in "xyz")
    other = np.array([Draw(uniform=(2.0, 4.0)).value("b", s) for s in seeds])
    assert abs(np.corrcoef(uniform, other)[0, 1]) < 5 / np.sqrt(4000)
    # A draw depends on its seed and path alone.
    assert Draw(uniform=(0.0, 1.0)).value("a", 3) == Draw(uniform=(0.0, 1.0)).value("a", 3)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("scenario: hover\nseed: 3", "seed: Extra inputs are not permitted; known names here: "),
        ("scenario: hover\nseeds: 0", "seeds: write how many seeds (>= 1), or a list of"),
        ("scenario: hover\nseeds: [1, 2, 1]", "seeds: write how many seeds (>= 1), or a list"),
        ("scenario: hover\ncases: {a: {seeds: 1.5}}", "cases.a.seeds: write how many seeds"),
        ("seeds: 3", "case 'run' has no scenario, and the campaign has none either"),
        ("scenario: hover\nset: {seed: 1}", "set: 'seed': seeds are given by `seeds`"),
        (
            "scenario: hover\ndraw: {x: {uniform: [2, 1]}}",
            "draw.x: uniform: the first value must be less than the second",
        ),
        (
            "scenario: hover\ndraw: {x: {gauss: [2, 1]}}",
            "draw.x.gauss: Extra inputs are not permitted; known names here: choice, loguniform,",
        ),
        ("scenario: hover\ndraw: {x: {}}", "give one of uniform, normal, loguniform, choice; 0"),
        ("scenario: hover\nvary: {x: []}", "'x': write the values to try, as [VALUE, VALUE] or"),
        ("scenario: hover\nvary: {x: 3}", "'x': write the values to try, as [VALUE, VALUE] or"),
        ("scenario: hover\nvary: 3", "vary: write a mapping, such as {PATH: [VALUE, VALUE]}"),
        ("scenario: hover\nseeds: 1000000000", "seeds: 1,000,000,000 seeds; a campaign has"),
        ("scenario: hover\nseeds: [9223372036854775808]", "seeds: a seed is at most 92233720"),
        ("scenario: hover\nrequire: {x.max: 3}", "'x.max': write a bound as {max: 3}, with one or"),
        ("scenario: hover\nevents: wind", "events: write a list of events; [] for none"),
        ("scenario: hover\nrequire: {x: {}}", "require.x: give at least one of min, max, equals"),
        ("scenario: hover\nrequire: {x: {min: 2, max: 1}}", "min 2 is greater than max 1"),
        ("scenario: hover\ncases: {a/b: {}}", "'a/b': start a name with a letter or digit"),
        ("scenario: hover\ncases: {a: {sets: {}}}", "cases.a.sets: Extra inputs"),
        ("- hover", "a campaign is a mapping of names to values"),
    ],
)  # fmt: skip
def test_a_wrong_file_names_the_field(tmp_path, text, message):
    with pytest.raises(CampaignError) as fault:
        campaign(tmp_path, text)
    assert message in str(fault.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("set: {control.obsrver: 1}", "case 'run': scenario hover.yaml: control.obsrver: Extra"),
        ("set: {duration_s: -1}", "duration_s: Input should be greater than 0 (got -1)"),
        ("set: {vehicle.hull.mass: 3}", "hull"),
        ("vary: {control.observer: [true, 7]}", "case 'run[control.observer=7]': scenario hover"),
        ("draw: {plant.step: {uniform: [0, 1]}}", "plant.step: Extra inputs"),
        ("require: {roll_deg.most: {max: 1}}", "'roll_deg.most' is no field of a summary"),
        (
            "require: {outcome: {equals: complete}}",
            "outcome: 'complete': choose from completed, giv",
        ),
        (
            "require: {outcome: {one_of: [completed, done]}}",
            "outcome: 'done': choose from completed",
        ),
        (
            "require: {outcome: {max: 3}}",
            "outcome: min and max are for numbers, and this is a text",
        ),
        (
            "require: {completed: {max: 1}}",
            "completed: min and max are for numbers, and this is true",
        ),
        (
            "require: {seed: {equals: one}}",
            "'one' is a text, and the field is a number",
        ),
        ("set: {goal.path: line}", "goal.path: write a group of values, {NAME: VALUE}, with names"),
        ("set: {events: null}", "events: write a list of events; [] for none"),
        (
            "draw: {duration_s: {uniform: [1, 1000001]}}",
            "draw: duration_s: the greatest value of uniform is 1000001.0, which is not allowed",
        ),
        (
            "draw: {duration_s: {loguniform: [1, 1000001]}}",
            "draw: duration_s: the greatest value of loguniform is 1000001.0, which",
        ),
        (
            "draw: {duration_s: {choice: [1, 2, 2000000]}}",
            "draw: duration_s: choice 3 is 2000000, w",
        ),
        (
            "draw: {duration_s: {normal: [10, 4]}}",
            "draw: duration_s: normal, mean - 3 standard deviations, is -2.0, which is not allowed",
        ),
        ("vehicle: none", "unknown vehicle 'none'"),
        (
            "baselines: {off: {control.laws: 1}}",
            "case 'run/off': scenario hover.yaml: cont",
        ),
    ],
)
def test_a_wrong_path_or_value_is_found_before_anything_runs(tmp_path, text, message):
    made = campaign(tmp_path, f"scenario: hover\n{text}")
    with pytest.raises(CampaignError) as fault:
        check_variants("small", variants(made))
    assert message in str(fault.value)


def test_a_campaign_of_too_many_runs_is_refused_before_they_are_listed(tmp_path):
    values = list(range(200))
    text = f"scenario: hover\nvary: {{a: {values}, b: {values}, c: {values}}}"
    with pytest.raises(CampaignError) as fault:
        variants(campaign(tmp_path, text), "none")
    assert str(fault.value) == (
        "campaign small: 8,000,000 runs, and at most 100,000 are allowed (case 'run' alone:"
        " 8,000,000 = 200 of a x 200 of b x 200 of c x 1 seed); vary fewer values, or draw them by"
        " seed instead of varying them"
    )


def test_good_requirements_and_draws_pass_the_check(tmp_path):
    text = """scenario: hover
seeds: 3
draw: {duration_s: {uniform: [1, 2]}, vehicle.hull.cg_m.2: {normal: [0.012, 0.0005]}}
require: {outcome: {one_of: [completed, error]}, roll_deg.max: {max: 3}, completed: {equals: true}}
"""
    check_variants("small", variants(campaign(tmp_path, text)))


def test_the_number_of_runs_is_said_first(tmp_path, capsys):
    file = write(tmp_path, "scenario: hover\nseeds: 12\nset: {duration_s: -1}")
    assert main(["campaign", str(file)]) == 2
    assert "12 runs" in capsys.readouterr().out


def test_a_requirement_on_what_depends_on_the_run_is_allowed(tmp_path):
    text = "scenario: hover\nrequire: {node_counters.navigation.refused: {max: 3}}"
    check_variants("small", variants(campaign(tmp_path, text)))


def test_every_campaign_that_comes_with_the_project_can_be_run():
    assert "observer_study" in known_campaigns()
    for name in known_campaigns():
        made = load_campaign(name)
        check_variants(name, variants(made))


def test_the_command_says_what_is_wrong_and_makes_no_folder(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["campaign", "nothing"]) == 2
    assert "unknown campaign 'nothing'; choose one of " in capsys.readouterr().err
    assert main(["campaign", str(write(tmp_path)), "--select", "gust"]) == 2
    assert "--select 'gust'" in capsys.readouterr().err
    assert main(["campaign", str(tmp_path / "small.yaml"), "--resume"]) == 2
    assert "--resume: say with --output DIR" in capsys.readouterr().err
    small = str(tmp_path / "small.yaml")
    for picture, message in (
        ("x.foo", "--picture x.foo: '.foo' is no kind of image; choose from ."),
        ("none/x.png", "--picture none/x.png: there is no folder none"),
    ):
        assert main(["campaign", small, "--picture", picture]) == 2
        assert message in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()
