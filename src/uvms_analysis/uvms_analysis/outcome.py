"""The outcome of a run: completed, or why not."""

from dataclasses import dataclass
from typing import Literal

COMPLETED, GIVEN_UP, ABORTED, INVALID = "completed", "given up", "aborted", "invalid"
Word = Literal["completed", "given up", "aborted", "invalid"]

EXIT_CODES: dict[str, int] = {COMPLETED: 0, GIVEN_UP: 1, ABORTED: 1, INVALID: 3}
"""Of `uvms run` and `uvms simulate`; 2 is bad input, 130 and 143 are SIGINT and SIGTERM."""


@dataclass(frozen=True)
class Outcome:
    """One of four words, and the reasons in words; no reasons where it is `completed`.

    completed: the task was done, within its limits, and the log proves it.
    given up: the run went to its end, but the task was not done, or a limit was not kept.
    aborted: the run ended before its end: a signal, a node that died, a plant that diverged.
    invalid: what was recorded proves nothing: messages are missing, commands came late, somebody
        else took part.
    """

    word: Word
    reasons: tuple[str, ...] = ()

    @property
    def completed(self) -> bool:
        """Whether the outcome is `completed`."""
        return self.word == COMPLETED
