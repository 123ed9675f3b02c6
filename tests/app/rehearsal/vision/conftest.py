"""A rendered picture that the tests of this folder share."""

import numpy as np
import pytest

from app.rehearsal.camera.look import Look
from bench.table_photo import Photo, photo
from planner import load_garment
from planner.geometry.pose import Pose2


@pytest.fixture(scope="session")
def shirt_photo() -> Photo:
    """Return a picture of the T-shirt beside a sheet of A4, blue on wood, the camera tilted."""
    outline = np.array(load_garment("t-shirt").outline)
    ring = Pose2(0.0, 0.0, 0.4).to_outer(outline - (outline.min(axis=0) + outline.max(axis=0)) / 2.0)
    look = Look((110.0, 150.0, 190.0), (150.0, 70.0, 40.0), tilt_rad=0.25)
    return photo([ring], look, 5, sheet=(0.62, -0.3, 0.4))
