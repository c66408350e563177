"""The documentation builds as a site whose links all lead somewhere, without any network."""

import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest
from project import PACKAGES, ROOT

pytestmark = pytest.mark.slow


class Page(HTMLParser):
    """What a page links to, what it loads, and the places in it."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: set[str] = set()
        self.loads: set[str] = set()
        self.places: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        named = {key: value for key, value in attrs if value is not None}
        self.places |= {named[key] for key in ("id", "name") if key in named}
        if tag == "a" and "href" in named:
            self.links.add(named["href"])
        elif tag in ("img", "script") and "src" in named:
            self.loads.add(named["src"])
        elif tag == "link" and "stylesheet" in named.get("rel", ""):
            self.loads.add(named["href"])


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    place = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(place)]
    command += ["--config-file", str(ROOT / "tools/site/mkdocs.yml")]
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return {path: Page(path) for path in place.rglob("*.html")}


def test_every_link_leads_to_a_page_and_a_place_in_it(site):
    dead = []
    for path, page in site.items():
        if path.name == "404.html":
            continue  # its links are from the root of a server
        for link in page.links:
            if re.match(r"[a-z]+:", link):
                continue
            file, _, place = unquote(link).partition("#")
            target = (path.parent / file).resolve() if file else path
            target = target / "index.html" if target.is_dir() else target
            known = site[target].places | {""} if target in site else {place}
            if not target.exists() or place not in known:
                dead.append((path.name, link))
    assert dead == []


def test_nothing_is_loaded_from_elsewhere(site):
    loaded = {item for page in site.values() for item in page.loads}
    assert [item for item in loaded if re.match(r"(https?:)?//", item)] == []


def test_every_page_of_the_documentation_is_in_the_site(site):
    wanted = {path.stem for path in (ROOT / "docs").glob("*.md")} - {"README"}
    assert wanted <= {path.stem for path in site}


@pytest.mark.parametrize("package", PACKAGES)
def test_the_reference_shows_the_docstrings_of_a_package(site, package):
    pages = [path for path in site if path.parts[-3:-1] == ("api", package)]
    assert pages
    described = [page for page in pages if 'class="doc doc-contents' in page.read_text("utf-8")]
    assert len(described) == len(pages)
