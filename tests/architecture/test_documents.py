"""Documents are finished: no mark of a gap is left, and what they link to is there."""

import re

import pytest
from project import ROOT

GAPS = ("<!-- fill", "@@", "TODO", "FIXME", "_TABLE\n")
DOCUMENTS = sorted(
    path
    for pattern in ("*.md", "docs/**/*.md", "benchmarks/*.md", "bringup/**/*.md", "src/*/*.md")
    for path in ROOT.glob(pattern)
)


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_gap_is_left_in_a_document(path):
    text = path.read_text(encoding="utf-8")
    assert [gap for gap in GAPS if gap in text] == []


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_what_a_document_links_to_is_there(path):
    links = re.findall(r"\]\(([^)#\s]+)", path.read_text(encoding="utf-8"))
    own = [link for link in links if not re.match(r"[a-z]+:", link)]
    assert [link for link in own if not (path.parent / link).exists()] == []
