#!/usr/bin/env python3
"""`python bringup/bringup.py SCENARIO ...` is the same as `uvms run SCENARIO ...`."""

import sys

from uvms_bringup.cli import main

if __name__ == "__main__":
    raise SystemExit(main(["run", *sys.argv[1:]]))
