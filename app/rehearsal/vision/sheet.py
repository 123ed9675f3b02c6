"""Find a sheet of paper or a marker in a picture: four corners that tell the table's plane."""

from dataclasses import replace

import cv2
import numpy as np

from app.rehearsal.vision.picture import Image
from app.rehearsal.vision.scale_said import SHEETS_M
from app.rehearsal.vision.snap import snapped, steepness
from app.rehearsal.vision.table_plane import USUAL_FOCAL, Focal, Plane, clockwise, plane_of
from planner.geometry.pose import FloatArray

_SHARE = (0.003, 0.25)
"""The range of a sheet's share of the picture's area."""

_WORST_MISFIT = 1200.0
"""The largest misfit of the corners of a sheet."""

_TELLS = 25.0
"""How much better one of A4 and Letter must fit to be distinguished from the other: five standard deviations."""

_LEAST_OF_STRONGEST = 0.2
"""The least strength of a sheet's faintest edge, as a share of its strongest."""

_SAME_PX = 20.0
_EDGE_PX = 4.0


def find_sheets(image: Image, names: tuple[str, ...], focal: Focal = USUAL_FOCAL) -> tuple[Plane, ...]:
    """Return the sheets of paper that may be meant, the best first: bright, even, four-sided, of the right sides."""
    found = [sheet for quad in _bright_quads(image) for sheet in _as_sheets(image, quad, names, focal)]
    return tuple(sorted(found, key=lambda plane: plane.misfit))


def like_best(sheets: tuple[Plane, ...]) -> tuple[Plane, ...]:
    """Return the sheets that are at the place of the best and fit about as well, of other sizes; the best first."""
    best = sheets[0]
    return tuple(
        one
        for one in sheets
        if one is best
        or (
            one.by != best.by
            and np.abs(one.corners - best.corners).max() < _SAME_PX
            and one.misfit - best.misfit <= _TELLS
        )
    )


def find_marker(image: Image, side_m: float, focal: Focal = USUAL_FOCAL) -> Plane | None:
    """Return the plane of the largest ArUco or AprilTag marker, its black square so wide; None where there is none."""
    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)
    kinds = (cv2.aruco.DICT_4X4_50, cv2.aruco.DICT_5X5_100, cv2.aruco.DICT_6X6_250, cv2.aruco.DICT_APRILTAG_36H11)
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    quads: list[FloatArray] = []
    for kind in kinds:
        dictionary = cv2.aruco.getPredefinedDictionary(kind)
        corners, _, _ = cv2.aruco.ArucoDetector(dictionary, parameters).detectMarkers(grey)
        quads += [np.asarray(corner, np.float64).reshape(4, 2) for corner in corners]
    if not quads:
        return None
    quad = max(quads, key=lambda one: abs(float(cv2.contourArea(np.asarray(one, np.float32)))))
    plane = plane_of("marker", quad, side_m, side_m, image.shape, focal)
    middle = quad.mean(axis=0)
    return replace(plane, corners=middle + 1.4 * (quad - middle))  # the white round the black belongs to it


def _bright_quads(image: Image) -> list[FloatArray]:
    """Return bright, even, convex figures with four corners, shape (4, 2), pixels; the largest first."""
    white = cv2.GaussianBlur(image, (0, 0), 1.0).min(axis=2)  # of paper all three colours are high
    least, most = (share * white.size for share in _SHARE)
    found: list[FloatArray] = []
    for level in range(60, 250, 10):
        mask = cv2.morphologyEx(np.asarray(white > level, np.uint8), cv2.MORPH_OPEN, np.ones((5, 5), np.uint8))
        contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        for contour in contours:
            area = cv2.contourArea(contour)
            if not least <= area <= most:
                continue
            hull = cv2.convexHull(contour)
            quad = cv2.approxPolyDP(hull, 0.03 * cv2.arcLength(hull, True), True)
            if len(quad) != 4 or area < 0.93 * cv2.contourArea(quad):
                continue
            line, _ = snapped(image, contour[:, 0].astype(np.float64), reach=_EDGE_PX)
            sharp = _by_sides(line, quad[:, 0].astype(np.float64))
            if (
                sharp is not None
                and _is_edged(image, sharp)
                and all(np.abs(sharp - other).max() > 6.0 for other in found)
            ):
                found.append(sharp)
    return sorted(found, key=lambda quad: -abs(float(cv2.contourArea(np.asarray(quad, np.float32)))))


def _is_edged(image: Image, quad: FloatArray) -> bool:
    """Return whether a figure has an edge on all four sides: the brighter part of an unevenly lit sheet has not."""
    low, high = (np.clip(end, 0, image.shape[1::-1]).astype(int) for end in (quad.min(0) - 12, quad.max(0) + 12))
    part, inner = image[low[1] : high[1], low[0] : high[0]], quad - low
    strengths = []
    for a, b in zip(inner, np.roll(inner, -1, axis=0), strict=True):
        along = (b - a) / np.hypot(*(b - a))
        points = a + np.linspace(0.15, 0.85, 24)[:, None] * (b - a)
        normals = np.repeat([[along[1], -along[0]]], len(points), axis=0)
        strengths.append(float(np.median(steepness(part, points, normals, np.arange(-2.0, 2.5, 0.5)).max(axis=1))))
    return min(strengths) >= _LEAST_OF_STRONGEST * max(strengths)


def _by_sides(contour: FloatArray, quad: FloatArray) -> FloatArray | None:
    """Return the corners at which lines through the contour's four sides meet; None where they do not."""
    lines = []
    for a, b in zip(quad, np.roll(quad, -1, axis=0), strict=True):
        along = (b - a) / np.hypot(*(b - a))
        places, off = (contour - a) @ along, (contour - a) @ np.array([-along[1], along[0]])
        length = float(np.hypot(*(b - a)))
        near = contour[(np.abs(off) < 0.05 * length + 2) & (places > 0.12 * length) & (places < 0.88 * length)]
        if len(near) < 8:
            return None
        vx, vy, x, y = cv2.fitLine(np.asarray(near, np.float32), cv2.DIST_HUBER, 0, 0.01, 0.01).ravel().tolist()
        lines.append(np.cross([x, y, 1.0], [x + vx, y + vy, 1.0]))
    met = [np.cross(lines[k - 1], lines[k]) for k in range(4)]
    if any(abs(point[2]) < 1e-9 for point in met):
        return None
    corners = np.array([point[:2] / point[2] for point in met])
    return corners if np.abs(corners - quad).max() < 0.2 * np.ptp(quad, axis=0).max() else None


def _as_sheets(image: Image, quad: FloatArray, names: tuple[str, ...], focal: Focal) -> list[Plane]:
    """Return a four-sided figure as sheets of each size, either way round, as far as a camera may see them so."""
    if not _is_paper(image, quad):
        return []
    found = []
    ring = clockwise(quad)
    for name in names:
        longer, shorter = SHEETS_M[name]
        ways = [plane_of(name, np.roll(ring, shift, axis=0), longer, shorter, image.shape, focal) for shift in (0, 1)]
        found.append(min(ways, key=lambda way: way.misfit))
    return [sheet for sheet in found if sheet.misfit <= _WORST_MISFIT and sheet.is_above(quad)]


def _is_paper(image: Image, quad: FloatArray) -> bool:
    """Return whether what a figure shows is bright, hardly coloured and even."""
    middle = quad.mean(axis=0)
    mask = np.zeros(image.shape[:2], np.uint8)
    cv2.fillConvexPoly(mask, np.asarray(middle + 0.85 * (quad - middle), np.int32), 1)
    lab = cv2.cvtColor(image, cv2.COLOR_BGR2Lab)[mask > 0].astype(np.float64)
    light, colour = lab[:, 0], lab[:, 1:] - 128.0
    return bool(np.median(light) > 140 and light.std() < 22 and np.hypot(*np.median(colour, axis=0)) < 22)
