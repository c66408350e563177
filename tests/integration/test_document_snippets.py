"""The parts that docs/extending.md shows are real: they run in the loop as they are printed."""

import re
from pathlib import Path

import pytest

from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate

PAGE = Path(__file__).parents[2] / "docs" / "extending.md"
BLOCK = re.compile(r"```python\n# my_package/(\w+)\.py\n(.*?)```", re.DOTALL)


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """The page's modules as a package on the path."""
    folder = tmp_path_factory.mktemp("page") / "page_package"
    folder.mkdir()
    (folder / "__init__.py").touch()
    for name, code in BLOCK.findall(PAGE.read_text(encoding="utf-8")):
        (folder / f"{name}.py").write_text(code, encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder.parent))
        yield folder


@pytest.mark.parametrize(
    ("name", "setting"),
    [
        ("arm_swing", "control.law=page_package.my_law:MyLaw"),
        ("manipulation", "planner.method=page_package.my_planner:KeepGoing"),
    ],
)
def test_a_part_of_the_page_runs_in_the_loop(package, name, setting):
    settings = [setting]
    if "law" in setting:
        settings.append("control.parameters.bandwidth=0.8")
    scenario = load_scenario(name, settings, duration_s=10.0)
    vehicle = scenario.load_vehicle()
    goal = scenario.goal.build(vehicle, scenario.plant)
    roll = []
    assert simulate(scenario, vehicle, goal, observe=lambda t: roll.append(t.truth.odometry))
    assert abs(roll[-1].position[2] - 10.0) < 0.5
    assert len(roll) == 201
