"""What `uvms view` does: opens the page, or writes a file."""

import webbrowser
from argparse import Namespace
from contextlib import suppress

from uvms_analysis.errors import determine
from uvms_bringup.viewer.export import export
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.page import LogPage


def show(options: Namespace) -> int:
    """Do what the options of `uvms view` say."""
    source = determine(lambda: LogSource(options.log))
    if options.export is not None:
        print(export(source, options.export))
        return 0
    page = LogPage(source, options.host, options.port)
    print(f"{source.name}: {page.address} (Ctrl-C ends it)", flush=True)
    if not options.no_browser:
        webbrowser.open(page.address)
    with suppress(KeyboardInterrupt):
        page.serve()
    return 0
