"""A full disk is no result of a run: rows stay, logs are noted, and the campaign can go on."""

import json
import resource
from contextlib import contextmanager

import pytest
from campaigns import conducted, journal_rows, write

from uvms_bringup.campaign.file import load_campaign
from uvms_bringup.campaign.journal import Journal
from uvms_bringup.campaign.plan import runs, variants
from uvms_bringup.campaign.results import Results
from uvms_bringup.campaign.row import MISSING_LOG, OF_MACHINE, row_of_fault, without_timings
from uvms_bringup.campaign.worker import make_row
from uvms_bringup.cli import main
from uvms_bringup.errors import CampaignError

SHORT = "scenario: hover\nset: {duration_s: 1.0}\nseeds: 2\n"


@contextmanager
def room(size):
    """No file grows beyond `size` bytes, as on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def made(tmp_path, text=SHORT):
    campaign = load_campaign(str(write(tmp_path, text)))
    return campaign, list(runs(variants(campaign)))


@pytest.mark.parametrize("size", [0, 100_000])
def test_a_log_that_cannot_be_written_leaves_the_row_of_the_run(tmp_path, size):
    run = made(tmp_path)[1][0]
    alone = make_row(run, tmp_path, "none")
    with room(size):
        row = make_row(run, tmp_path, "all")
    assert without_timings(row) == without_timings(alone)
    assert (row["passed"], row["outcome"]) == (True, "completed")
    assert "File too large" in row[MISSING_LOG]
    assert not list((tmp_path / "logs").glob("*"))


def test_a_missing_log_of_a_failed_run_does_not_change_its_reason(tmp_path):
    run = made(tmp_path, SHORT + "require: {roll_deg.max: {max: 1.0e-9}}\n")[1][0]
    with room(100_000):
        row = make_row(run, tmp_path, "failed")
    assert row["outcome"] == "completed"
    assert row["failed"][0].startswith("roll_deg.max is")
    assert MISSING_LOG in row


def test_a_journal_that_cannot_be_written_says_what_to_do(tmp_path):
    _, (one, two) = made(tmp_path)
    journal = Journal(tmp_path)
    journal.begin({"revision": "x", "digests": {}})
    journal.add(row_of_fault(one, "no reason"))
    before = journal.path.read_bytes()
    with room(len(before) + 10), pytest.raises(CampaignError) as fault:
        journal.add(row_of_fault(two, "no reason"))
    assert str(fault.value) == (
        f"{journal.path}: cannot be written: File too large; its 1 rows are kept: mend the cause,"
        f" and go on with --resume --output {tmp_path}"
    )
    assert journal.path.read_bytes() == before
    journal.add(row_of_fault(two, "no reason"))
    journal.close()
    assert list(Journal(tmp_path).rows) == [one.key, two.key]


def test_errors_of_the_machine_are_made_again_on_resume(tmp_path):
    campaign, (one, _) = made(tmp_path)
    file, folder = tmp_path / "small.yaml", tmp_path / "out"
    conducted(file, folder, workers=1)
    head, *rows = (folder / "rows.jsonl").read_text().splitlines()
    lost = row_of_fault(one, "[Errno 28] No space left on device", of_machine=True)
    (folder / "rows.jsonl").write_text("\n".join([head, json.dumps(lost), rows[1], ""]))
    before = Results(campaign, variants(campaign), folder, Journal(folder).rows)
    assert before.notes()[0].startswith("1 runs could not be made because of the machine ([Errno")
    results, table = conducted(file, folder, workers=1, resume=True)
    assert (results.passed, results.notes()) == (2, [])
    assert len(journal_rows(folder)) == 3
    assert OF_MACHINE not in table[0]


def test_an_error_of_the_run_is_not_made_again(tmp_path):
    _, (one, _) = made(tmp_path)
    journal = Journal(tmp_path)
    journal.begin({})
    for of_machine in (False, True):
        journal.add(row_of_fault(one, "broken", of_machine))
        assert journal.is_made(one.key) is not of_machine


def test_a_damaged_row_names_its_line_and_the_remedy(tmp_path):
    good = json.dumps({"case": "run", "seed": 1})
    (tmp_path / "rows.jsonl").write_text(f"{{}}\n{good}\n{good[:9]}\n{good}\n")
    with pytest.raises(
        CampaignError, match=r"rows\.jsonl: line 3 is damaged: delete that line, and"
    ):
        Journal(tmp_path)


def test_going_on_where_nothing_was_begun_is_an_error(tmp_path, capsys):
    write(tmp_path)
    folder = tmp_path / "none"
    words = ["campaign", str(tmp_path / "small.yaml"), "--resume", "--output", str(folder)]
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert f"--resume --output {folder}: there is no campaign to go on with" in err
    assert "results in" not in out
    assert not folder.exists()
