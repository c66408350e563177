"""Fig. 10: the manipulation in 3-D, at four moments."""

from pathlib import Path

from PIL import Image

from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.picture import picture
from uvms_bringup.viewer.scene_model import SceneModel

TIMES_S = (1.0, 301.0, 601.0, 901.0)
"""Beginning and end of the three phases."""
CAMERA = "wide"
SIZE = (640, 360)


def write_snapshots(run: Path, file: Path) -> Path:
    """Four pictures of a run, two by two, in one file."""
    source = LogSource(run)
    model = SceneModel(source.setting)
    sheet = Image.new("RGB", (2 * SIZE[0], 2 * SIZE[1]))
    for index, time in enumerate(TIMES_S):
        one = picture(model, source.moment(time), CAMERA, "manipulation", SIZE)
        sheet.paste(one, (index % 2 * SIZE[0], index // 2 * SIZE[1]))
    sheet.save(file, optimize=True)
    return file
