"""A campaign from its file to its folder: runs what is not there yet, and writes the results."""

import json
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_bringup.campaign.check import check_variants
from uvms_bringup.campaign.file import CAMPAIGN_FILE, Campaign, read_campaign
from uvms_bringup.campaign.journal import Journal
from uvms_bringup.campaign.plan import Run, Variant, runs, variants
from uvms_bringup.campaign.progress import CampaignProgress
from uvms_bringup.campaign.results import Results, write_text
from uvms_bringup.campaign.row import Row, is_failed
from uvms_bringup.campaign.worker import Logs
from uvms_bringup.claim import Claim, Holder, TakenError
from uvms_bringup.errors import CampaignError
from uvms_bringup.run_id import new_run_id
from uvms_bringup.session import git_revision
from uvms_bringup.stopped import SignalWatch, Stopped
from uvms_core.yaml_text import dump_yaml

CLAIM_FILE = ".campaign.lock"


def _silent(line: str) -> None:
    """Says nothing."""


@dataclass(frozen=True)
class CampaignRunner:
    """How a campaign is run.

    Args:
        workers: processes on this machine, where no scheduler is given.
        scheduler: address of one that runs already; "" for none.
        resume: go on with what is in the folder.
        select: shell pattern of the cases to run.
        logs: of which runs a log is kept.
        say: takes each line that there is to say before the runs begin.
    """

    workers: int = 1
    scheduler: str = ""
    resume: bool = False
    select: str = "*"
    logs: Logs = "none"
    say: Callable[[str], None] = _silent

    def run(self, campaign: Campaign, folder: Path, command: str) -> tuple[Results, Stopped | None]:
        """Run what is not there yet; returns the results, and the signal that ended it, if any.

        Raises:
            CampaignError: the campaign or its folder is not right, or the scheduler is gone; what
                was computed by then stays in the folder.
        """
        if self.resume and not (folder / CAMPAIGN_FILE).is_file():
            raise CampaignError(
                f"--resume --output {folder}: there is no campaign to go on with (no"
                f" {CAMPAIGN_FILE}); leave out --resume to begin one there"
            )
        chosen = variants(campaign, self.select)
        self.say(_size(chosen))
        self._try_scheduler()
        digests = check_variants(campaign.campaign, chosen)
        claim = _claimed(folder, command)
        try:
            journal = self._journal(campaign, digests, folder)
            self.say(f"results in {folder}")
            try:
                stopped = self._run(chosen, folder, journal)
            except BaseException:
                with suppress(CampaignError):  # what ended the campaign is what counts
                    _written(campaign, folder, journal)
                raise
            return _written(campaign, folder, journal), stopped
        finally:
            claim.release()

    def _try_scheduler(self) -> None:
        """Find out at once whether it is there: checking many cases takes a while."""
        if self.scheduler:
            from uvms_bringup.campaign.cluster import Cluster

            with Cluster(0, self.scheduler):
                pass

    def _journal(self, campaign: Campaign, digests: dict[str, str], folder: Path) -> Journal:
        journal = Journal(folder)
        if journal.head and not self.resume:
            raise CampaignError(
                f"{folder} holds a campaign already; go on with it by --resume, or give another"
                " --output"
            )
        if journal.head:
            _compare(campaign, folder)
            self._note_revision(journal)
        else:
            text = f"# A copy with full paths; what was run.\n{dump_yaml(plain(campaign))}"
            write_text(folder / CAMPAIGN_FILE, text)
        for case, begun in journal.head.get("digests", {}).items():
            if digests.get(case, begun) != begun:
                raise CampaignError(
                    f"--resume: the scenario or the vehicle of case {case!r} has changed since the"
                    f" campaign in {folder} was begun; start it anew in another folder"
                )
        journal.begin({"revision": git_revision(), "digests": digests})
        return journal

    def _note_revision(self, journal: Journal) -> None:
        begun = journal.head.get("revision")
        if begun != git_revision():
            self.say(
                f"note: the rows that are there are from revision {begun}, this is {git_revision()}"
            )

    def _run(self, chosen: Sequence[Variant], folder: Path, journal: Journal) -> Stopped | None:
        everything = list(runs(tuple(chosen)))
        left = [run for run in everything if not journal.is_made(run.key)]
        made = [journal.rows[run.key] for run in everything if journal.is_made(run.key)]
        if not left:
            return None
        with SignalWatch() as signals:
            signals.begin()
            try:
                self._make(left, made, folder, journal, signals)
            except Stopped as stopped:
                return stopped
        return None

    def _make(
        self,
        left: Sequence[Run],
        made: Sequence[Row],
        folder: Path,
        journal: Journal,
        signals: SignalWatch,
    ) -> None:
        from uvms_bringup.campaign.cluster import Cluster  # takes a second to import

        with Cluster(min(self.workers, len(left)), self.scheduler) as cluster:
            signals.check()
            for note in cluster.check(git_revision()):
                self.say(f"note: {note}")
            failed = sum(map(is_failed, made))
            with CampaignProgress(len(left) + len(made), len(made), failed) as progress:
                for row in cluster.rows(iter(left), folder, self.logs, signals.check):
                    journal.add(row)
                    progress.add(is_failed(row))


def _size(chosen: Sequence[Variant]) -> str:
    """How many runs there are, in words."""
    count = sum(len(one.seeds) for one in chosen)
    words = "1 run" if count == 1 else f"{count:,} runs"
    if len(chosen) == 1:
        return words
    return f"{words}: {len(chosen):,} combinations of cases, grids and baselines with their seeds"


def _written(campaign: Campaign, folder: Path, journal: Journal) -> Results:
    """The results, in their files."""
    journal.close()
    results = Results(campaign, variants(campaign), folder, journal.rows)
    results.write()
    return results


def _claimed(folder: Path, command: str) -> Claim:
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return Claim(folder / CLAIM_FILE, Holder(new_run_id(), os.getpid(), command))
    except TakenError as other:
        raise CampaignError(f"--output {folder}: belongs to {other}, which is still running") from (
            other
        )
    except OSError as fault:
        raise CampaignError(f"--output {folder}: {fault.strerror or fault}") from fault


def plain(campaign: Campaign) -> dict[str, Any]:
    """The campaign as plain data, without what it does not give."""
    return campaign.model_dump(mode="json", exclude_unset=True)


def copied_campaign(folder: Path) -> Campaign:
    """The campaign in a folder of results.

    Raises:
        CampaignError: there is none.
    """
    path = folder / CAMPAIGN_FILE
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as fault:
        raise CampaignError(f"{folder}: holds no campaign: {path.name}: {fault.strerror}") from (
            fault
        )
    return read_campaign(text, path)


def _compare(campaign: Campaign, folder: Path) -> None:
    """Refuse to go on with a campaign that is another one by now."""
    begun, now = plain(copied_campaign(folder)), plain(campaign)
    changes = list(differences(begun, now))
    if changes:
        raise CampaignError(
            f"--resume: the campaign in {folder} was begun with other values: {'; '.join(changes)}"
        )


def differences(one: Any, two: Any, path: str = "") -> Iterator[str]:
    """Where two nested values differ, in words."""
    if isinstance(one, dict) and isinstance(two, dict):
        for key in [*one, *(key for key in two if key not in one)]:
            inner = f"{path}.{key}" if path else str(key)
            if key not in one or key not in two:
                yield f"{inner} is new" if key not in one else f"{inner} is missing now"
            else:
                yield from differences(one[key], two[key], inner)
    elif one != two:
        yield f"{path} was {json.dumps(one)}, is {json.dumps(two)}"
