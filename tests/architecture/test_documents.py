"""Documents are finished: no gaps, no dead links, a short first page, a valid citation."""

import re
from datetime import date

import pytest
import yaml
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


def test_the_first_page_is_short_and_shows_the_vehicle():
    """At most 600 words, tables included, and a picture that loads quickly."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.split()) <= 600
    pictures = re.findall(r"!\[[^]]+\]\(([^)]+)\)", text)
    assert pictures
    for picture in pictures:
        assert 10_000 < (ROOT / picture).stat().st_size < 400_000
    assert "make run" in text
    assert "make test" in text


def test_the_index_lists_every_page():
    """Every document below docs/ can be reached from docs/README.md in one step."""
    index = (ROOT / "docs/README.md").read_text(encoding="utf-8")
    linked = {link.split("#")[0] for link in re.findall(r"\]\(([^)\s]+)", index)}
    pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"README.md"}
    assert pages <= linked


def test_the_citation_file_is_complete():
    """Fields that CFF 1.2.0 demands, a date, and authors of software and paper."""
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["cff-version"] == "1.2.0"
    assert {"message", "title", "authors", "version", "license"} <= set(citation)
    date.fromisoformat(str(citation["date-released"]))
    (paper,) = citation["references"]
    assert paper["doi"] == "10.1007/s11044-016-9538-3"
    assert paper["type"] == "article"
    for author in (*citation["authors"], *paper["authors"]):
        assert set(author) in ({"name"}, {"family-names", "given-names"})


def test_the_change_log_has_a_section_for_the_version_of_the_packages():
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    sections = re.findall(r"^## \[([^]]+)\](?: - (\d{4}-\d{2}-\d{2}))?$", text, re.MULTILINE)
    assert sections[0] == ("Unreleased", "")
    released = dict(sections[1:])
    for version, day in released.items():
        assert re.fullmatch(r"\d+\.\d+\.\d+", version)
        date.fromisoformat(day)
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert released[citation["version"]] == str(citation["date-released"])


PLACEHOLDERS = re.compile(
    r"\.example\b|example\.(com|org|net)|your-?(name|org|user)\b|localhost:\d", re.IGNORECASE
)


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_document_has_a_placeholder_address(path):
    assert PLACEHOLDERS.findall(path.read_text(encoding="utf-8")) == []
