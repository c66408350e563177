"""Which stages of the set-up are done, and for which inputs: a JSON file in the environment."""

import hashlib
import json
import os
from pathlib import Path

from machine import SetupError


def digest(root, inputs, *also):
    """Hash of the files (folders: all files in them) below `root`, by name and content."""
    total = hashlib.sha256("\0".join(map(str, also)).encode())
    for name in inputs:
        for file in _files(root / name):
            total.update(str(file.relative_to(root)).encode() + b"\0")
            total.update(hashlib.sha256(file.read_bytes()).digest())
    return total.hexdigest()


def _files(path):
    if path.is_dir():
        return sorted(file for file in path.rglob("*") if file.is_file())
    if path.is_file():
        return [path]
    raise SetupError("%s is missing; restore it with `git checkout`." % path)


def kernel_sources(root):
    """Digest of the files with numerical kernels, which are all compiled anew if one changes."""
    files = []
    for folder in ("src", "bringup"):
        files += sorted((root / folder).rglob("*.py"))
    texts = {str(file.relative_to(root)): file.read_bytes() for file in files}
    return digest(
        root, [name for name, text in texts.items() if b"numba" in text or b"jit" in text]
    )


class Stamps:
    """The digests of the finished stages, and the name of a stage that was begun and not ended."""

    def __init__(self, path):
        self._path = Path(path)
        try:
            self._done = json.loads(self._path.read_text())
        except (OSError, ValueError):
            self._done = {}

    @property
    def present(self):
        """Whether any set-up has been here."""
        return bool(self._done)

    @property
    def interrupted(self):
        """The stage that a set-up began and never ended, or None."""
        return self._done.get("begun")

    def done(self, stage, key):
        """Whether the stage ended with these inputs."""
        return self._done.get(stage) == key

    def begin(self, stage):
        """Note that the stage is under way; until `end` it counts as not done."""
        self._done.pop(stage, None)
        self._save(dict(self._done, begun=stage))

    def end(self, stage, key):
        """Note that the stage has ended."""
        self._done[stage] = key
        self._done.pop("begun", None)
        self._save(self._done)

    def _save(self, content):
        self._path.parent.mkdir(parents=True, exist_ok=True)
        fresh = self._path.with_suffix(".new")
        fresh.write_text(json.dumps(content, indent=1) + "\n")
        os.replace(fresh, self._path)
        self._done = content
