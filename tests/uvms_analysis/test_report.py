"""The report draws every figure and writes a page that needs nothing else."""

import base64
import html
import json
import re

import pytest
from matplotlib.image import imread
from rewrite import rewrite
from synthetic import Known, write_log

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.report import FIGURES, report


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    write_log(folder / "run.mcap", Known(duration=6.0, path_duration=4.0))
    (folder / "summary.json").write_text(json.dumps({"completed": True, "wall_s": 2.0}))
    report(folder / "run.mcap")
    return folder


def test_every_figure_is_drawn(folder):
    for name in FIGURES:
        picture = imread(folder / f"{name}.png")
        assert picture.shape[1] > 900
        assert picture.std() > 0.02, f"{name} is empty"


def test_the_page_holds_all_figures_and_nothing_from_elsewhere(folder):
    page = (folder / "report.html").read_text(encoding="utf-8")
    images = re.findall(r'<figure id="(\w+)"><img [^>]*src="data:image/png;base64,([^"]+)"', page)
    assert [name for name, _ in images] == list(FIGURES)
    for name, data in images:
        assert base64.b64decode(data) == (folder / f"{name}.png").read_bytes()
    assert not re.search(r"""(src|href)=["'](?!data:)""", page)
    assert "url(" not in page


def test_the_page_describes_the_run(folder):
    page = (folder / "report.html").read_text(encoding="utf-8")
    for text in ("synthetic, seed 7", "completed", "git_revision", "abc", "config.yaml", "dark"):
        assert text in page
    assert "<tr><th>real_time_factor</th><td>3</td></tr>" in page
    assert "<tr><th>navigation_error_m.rms</th><td>0.03</td></tr>" in page


def test_what_users_wrote_is_escaped(tmp_path):
    with LogWriter(tmp_path / "run.mcap") as log:
        log.metadata("uvms", {"scenario": "<script>x</script>", "seed": 1})
    page = report(tmp_path / "run.mcap", tmp_path / "out").read_text(encoding="utf-8")
    assert "<script>" not in page
    assert "&lt;script&gt;x&lt;/script&gt;" in page


def test_figures_that_cannot_be_drawn_say_why(tmp_path):
    LogWriter(tmp_path / "run.mcap").close()
    page = report(tmp_path / "run.mcap").read_text(encoding="utf-8")
    assert page.count("No figure: ") == len(FIGURES)
    assert "Outcome: invalid" in page
    assert not list(tmp_path.glob("*.png"))


def test_a_broken_off_log_is_reported(tmp_path, folder):
    data = (folder / "run.mcap").read_bytes()
    (tmp_path / "run.mcap").write_bytes(data[: len(data) // 2])
    page = report(tmp_path / "run.mcap").read_text(encoding="utf-8")
    assert "The log is not complete: the writer was stopped early" in page
    assert "not completed" in page


def test_a_folder_that_cannot_be_made_is_named(folder, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(LogError, match="cannot be written"):
        report(folder / "run.mcap", tmp_path / "file" / "out")


def damaged_log(folder, tmp_path, whole: bytes, damaged: bytes):
    assert len(whole) == len(damaged)
    data = (folder / "run.mcap").read_bytes()
    (tmp_path / "run.mcap").write_bytes(data.replace(whole, damaged, 1))
    return tmp_path / "run.mcap"


def test_a_damaged_attachment_costs_only_what_needs_it(tmp_path, folder):
    log = damaged_log(folder, tmp_path, b"environment:", b"environm\xff\xfft:")
    page = html.unescape(report(log).read_text(encoding="utf-8"))
    assert "No figure: " in page
    assert "its attachment 'vehicle.yaml' is damaged" in page
    assert (tmp_path / "navigation.png").is_file()


@pytest.mark.parametrize(
    ("name", "whole", "other", "reason"),
    [
        ("vehicle.yaml", "environment:", "environmxxt:", "environment: Field"),
        ("vehicle.yaml", "environment:", "environment[", "is not valid YAML"),
        ("config.yaml", "seed: 7", "seed: [", "is not valid YAML"),
        ("config.yaml", "scenario: synthetic\nseed: 7", "- 7", "is not a mapping"),
    ],
)
def test_an_attachment_that_says_something_else_is_named(
    tmp_path, folder, name, whole, other, reason
):
    def change(attachments):
        text = attachments[name].decode()
        assert whole in text
        return attachments | {name: text.replace(whole, other, 1).encode()}

    log = RunLog.open(rewrite(folder / "run.mcap", tmp_path / "run.mcap", attachments=change))
    assert log.fault == ""
    read = log.configuration if "config" in name else lambda: Analysis(log).vehicle
    with pytest.raises(LogError, match=re.escape(f"its attachment {name!r}")) as fault:
        read()
    assert reason in str(fault.value)
