"""Hook of mkdocs: what the pages link to outside docs/ becomes a page of the site too.

A Markdown file is a page as it is, any other text a page with its contents, and a folder its
README.md or the list of its files. Links are rewritten to them, so that the site has no dead ends.
"""

import os
import posixpath
import re
from pathlib import Path, PurePosixPath

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).resolve().parents[2]
DOCS = PurePosixPath("docs")
PLACE = "repository"
"""Folder of the site for what lies outside docs/."""
LANGUAGES = {".py": "python", ".yaml": "yaml", ".yml": "yaml", ".toml": "toml", ".sh": "sh"}
LINK = re.compile(r"(\]\()([^)#\s]+)((?:#[^)\s]*)?\))")

_sources: dict[str, str] = {}
"""Path in the repository of each page that is made here, by its path in the site."""


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add a page for everything outside docs/ that a page links to, directly or not."""
    _sources.clear()
    waiting = [path.relative_to(ROOT).as_posix() for path in (ROOT / DOCS).rglob("*.md")]
    seen = set(waiting)
    while waiting:
        source = waiting.pop()
        for target in _targets(source):
            if target not in seen:
                seen.add(target)
                waiting.append(target)
                _add(files, config, target)
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Let the page's links lead to the pages of the site."""
    place = page.file.src_uri
    source = _sources.get(place, str(DOCS / place))

    def rewritten(found: re.Match[str]) -> str:
        target = _resolved(source, found[2])
        if target is None:
            return found[0]
        own = posixpath.relpath(_place(target), posixpath.dirname(place) or ".")
        return found[1] + own + found[3]

    return LINK.sub(rewritten, markdown)


def _targets(source: str) -> set[str]:
    """What a file of the repository links to outside docs/, as paths from its root."""
    path = ROOT / source
    if path.suffix != ".md":
        return set()
    links = LINK.findall(path.read_text(encoding="utf-8"))
    found = {_resolved(source, link) for _, link, _ in links}
    return {each for each in found if each is not None and _is_shown(each)}


def _resolved(source: str, link: str) -> str | None:
    """The path that a link leads to; None for the web and for what is not there."""
    if re.match(r"[a-z]+:", link):
        return None
    target = posixpath.normpath(posixpath.join(posixpath.dirname(source), link))
    if (ROOT / target / "README.md").is_file():
        target = posixpath.join(target, "README.md")
    return target if (ROOT / target).exists() else None


def _is_shown(target: str) -> bool:
    """Whether it lies outside docs/, so that a page has to be made of it."""
    return not target.startswith(f"{DOCS}/")


def _place(target: str) -> str:
    """Path in the site of something in the repository."""
    if not _is_shown(target):
        return posixpath.relpath(target, DOCS)
    return f"{PLACE}/{target}" if target.endswith(".md") else f"{PLACE}/{target}.md"


def _add(files: Files, config: MkDocsConfig, target: str) -> None:
    place = _place(target)
    _sources[place] = target
    files.append(File.generated(config, place, content=_content(ROOT / target)))


def _content(path: Path) -> str:
    """Markdown of a page about a file or a folder."""
    name = path.relative_to(ROOT).as_posix()
    if path.suffix == ".md":
        return path.read_text(encoding="utf-8")
    if path.is_dir():
        return f"# {name}\n\n" + "\n".join(f"- `{each}`" for each in _listed(path)) + "\n"
    fence = "~~~~"
    language = LANGUAGES.get(path.suffix, "text")
    text = path.read_text(encoding="utf-8")
    return f"# {name}\n\n{fence}{language}\n{text}\n{fence}\n"


def _listed(folder: Path) -> list[str]:
    """Files of a folder and those below it."""
    found = []
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(each for each in folders if not each.startswith(("__", ".")))
        found += [(Path(place) / each).relative_to(folder).as_posix() for each in sorted(names)]
    return found
