"""What an editable installation lacks to be an ament prefix: index, share files, lib/<package>."""

import configparser
import os
import shutil

PREFIX_HOOK = (
    "import os, sys; os.environ['AMENT_PREFIX_PATH'] = os.pathsep.join(dict.fromkeys("
    "[sys.prefix] + os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep))).strip(os.pathsep)\n"
)
_ENTRIES = "%s-*.dist-info/entry_points.txt"
SHARED = ("package.xml", "config", "launch")


def site_packages(prefix):
    """The environment's folder of packages."""
    return next((prefix / "lib").glob("python3.*/site-packages"))


def complete(prefix, packages):
    """Make the environment an ament prefix that holds these packages (name -> source folder)."""
    (site_packages(prefix) / "uvms_ament_prefix.pth").write_text(PREFIX_HOOK)
    for name, source in packages.items():
        _index(prefix, name)
        _share(prefix / "share" / name, source)
        _executables(prefix, name)


def _index(prefix, name):
    marker = prefix / "share/ament_index/resource_index/packages" / name
    marker.parent.mkdir(parents=True, exist_ok=True)
    marker.write_text("")


def _share(share, source):
    _empty(share)
    for name in SHARED:
        if (source / name).exists():
            (share / name).symlink_to(source / name)


def _executables(prefix, name):
    folder = prefix / "lib" / name
    _empty(folder)
    for program in _console_scripts(prefix, name):
        (folder / program).symlink_to(os.path.relpath(str(prefix / "bin" / program), str(folder)))


def _console_scripts(prefix, name):
    parser = configparser.ConfigParser(delimiters=("=",))
    parser.read(str(entry) for entry in site_packages(prefix).glob(_ENTRIES % name))
    return list(parser["console_scripts"]) if "console_scripts" in parser else []


def _empty(folder):
    shutil.rmtree(str(folder), ignore_errors=True)
    folder.mkdir(parents=True)
