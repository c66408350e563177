"""A browser for the tests of the 3-D page: the machine's, else one from the npm registry."""

import os
import shutil
import tarfile

import stamps

PACKAGE = "@sparticuz/chromium@153.0.0"
"""A Chromium without a window that needs no installation, MIT licence; 70 MB to fetch."""
FILES = ("chromium", "swiftshader.tar", "al2023.tar")
"""Program, software renderer, and the libraries that a bare machine lacks."""
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
UNPACK = (
    "const fs=require('fs'),z=require('zlib');const[,from,to]=process.argv;"
    "fs.writeFileSync(to,z.brotliDecompressSync(fs.readFileSync(from)))"
)


class Browser:
    """Nothing where there is a browser; without npm the page's tests say what to do."""

    name, title = "browser", "a browser for the tests of the 3-D page"

    def key(self, context, explicit):
        """The package, and whether it is needed and can be had."""
        return stamps.digest(context.root, [], PACKAGE, system_browser(), shutil.which("npm"))

    def run(self, stage, context):
        """Fetch and unpack it into .venv/browser."""
        folder = context.prefix / "browser"
        shutil.rmtree(str(folder), ignore_errors=True)
        if system_browser() or not (shutil.which("npm") and shutil.which("node")):
            return
        folder.mkdir()
        stage.run(["npm", "pack", "--silent", PACKAGE], context.env, folder)
        (archive,) = folder.glob("*.tgz")
        with tarfile.open(str(archive)) as packed:
            packed.extractall(str(folder))
        for name in FILES:
            source = folder / "package" / "bin" / (name + ".br")
            stage.run(["node", "-e", UNPACK, source, folder / name], context.env)
        for name in FILES[1:]:
            with tarfile.open(str(folder / name)) as packed:
                packed.extractall(str(folder))
            os.remove(str(folder / name))
        os.chmod(str(folder / "chromium"), 0o755)
        os.remove(str(archive))
        shutil.rmtree(str(folder / "package"))


def system_browser():
    """The machine's browser, or that which UVMS_BROWSER names; None without one."""
    named = os.environ.get("UVMS_BROWSER")
    return named or next(filter(None, map(shutil.which, NAMES)), None)
