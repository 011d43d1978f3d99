"""A folder with everything that is looked at in it, read once and shared by all windows.

Verified by tests/unit/test_viewer_stages.py and tests/end_to_end/test_view.py.
"""

from __future__ import annotations

from workbench.viewer.folder import ReportFolder
from workbench.viewer.modes_stage import ModesStage
from workbench.viewer.stages import RoverStage, WheelStage, wheel_stage

__all__ = ["Results"]


class Results:
    """A folder with its stages; what cannot be read is said before the page opens.

    Attributes
    ----------
    folder : as it was found
    wheels : by (model, orientation [deg])
    rovers : by (scenario, tire)
    modes : in the folder's order
    """

    def __init__(self, folder: ReportFolder) -> None:
        self.folder = folder
        self.wheels: dict[tuple[str, float], WheelStage] = {}
        for key in dict.fromkeys((one.model, one.orientation) for one in folder.fields):
            files = [(one.load, one.path) for one in folder.fields if (one.model, one.orientation) == key]
            self.wheels[key] = wheel_stage(
                key[1], files, folder.points.get(key), folder.pressures.get(key), folder.ground
            )
        self.rovers = {key: RoverStage(path) for key, path in folder.motions.items()}
        self.modes = [ModesStage(file) for file in folder.modes]
