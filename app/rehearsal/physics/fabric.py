"""Parameters of a simulation: the mechanics of cloth and table, and the resolution."""

import math
from dataclasses import dataclass

from planner.cloth.garment import DEFAULT_THICKNESS_M, LAYER_AIR_M

GRAVITY_M_S2 = 9.81

BUCKLED = 0.2
"""The share of its length by which a row is pushed together where it bears what buckles it."""

_LAYER_MIN_M = 0.0014
"""How far apart layers are at least (m).

Cloth that has lost a contact falls by .6 mm in a time step, and must not come to lie on the far side of a layer.
"""


@dataclass(frozen=True, slots=True)
class Fabric:
    """The mechanics of a cloth on a table.

    Attributes:
        density_kg_m2: the areal density.
        stretch_n_m: the stiffness along the threads, Young's modulus times thickness (N/m). Across them cloth does not
            contract.
        push_n_m: the same where cloth is pushed together (N/m); None where it gives way as a mesh needs (`pushed_n_m`).
        shear_n_m: the stiffness in shear, in which threads turn against each other: force per width and angle (N/m).
        bending_length_m: the cube root of the bending stiffness per width over the weight per area (m), which textile
            laboratories measure on a strip that hangs over an edge: half of its length when it droops by 41.5 degrees.
        bend_friction_per_m: the curvature at which bent cloth's stiffness bears as much as the friction of its threads
            (1/m): half of 2HB over B of the Kawabata system, on average of six denims (Journal of Textiles 2016,
            4614168, table 5).
        thickness_m: the cloth's thickness where fingers press it (m).
        damping_s: Rayleigh damping of stretch and bending (s).
        drag_per_s: the deceleration by the air, per speed (1/s).
        friction: the friction coefficient on the table.
        self_friction: the friction coefficient of cloth on cloth.
    """

    density_kg_m2: float = 0.2
    stretch_n_m: float = 1000.0
    push_n_m: float | None = None
    shear_n_m: float = 80.0
    bending_length_m: float = 0.018
    bend_friction_per_m: float = 44.0
    thickness_m: float = DEFAULT_THICKNESS_M
    damping_s: float = 0.002
    drag_per_s: float = 1.0
    friction: float = 1.0
    self_friction: float = 0.5

    @property
    def layer_m(self) -> float:
        """The distance that contacts keep between layers (m)."""
        return max(self.thickness_m + LAYER_AIR_M, _LAYER_MIN_M)

    @property
    def bend_nm(self) -> float:
        """The bending stiffness per width (N m)."""
        return self.density_kg_m2 * GRAVITY_M_S2 * self.bending_length_m**3

    def pushed_n_m(self, edge_m: float) -> float:
        """Return the stiffness along threads that are pushed together, on a mesh of rows some way apart (N/m).

        Cloth that is pushed buckles on lengths that the mesh does not resolve: a row as long as that under pi^2 of the
        bending stiffness over its square, and it bears no more. So the mesh bears as much when it has given way by
        `BUCKLED`. Threads that bear more carry layers over creases as folded plates, twice as high; those that bear
        less are squeezed where a crease should roll.
        """
        if self.push_n_m is not None:
            return self.push_n_m
        return math.pi**2 * self.bend_nm / edge_m**2 / BUCKLED

    @property
    def shell_thickness_m(self) -> float:
        """The thickness of a solid shell that stretches and bends as this cloth does (m)."""
        return math.sqrt(12.0 * self.bend_nm / self.stretch_n_m)

    @property
    def young_pa(self) -> float:
        """Young's modulus of that shell (Pa)."""
        return self.stretch_n_m / self.shell_thickness_m


_POINTS = 800
"""About how many points a mesh has, unless rows would be nearer or further apart than below."""

_NEAREST_M, _FURTHEST_M = 0.012, 0.018
"""How near rows are at least, two thirds of a bending length, and how far apart at most, a bending length (m).

With rows 20 mm apart, more than the loop of a crease is high, a row 10 mm beyond a fold line stood upright once folded,
and fell inwards or outwards as it happened: a crease of 60 cm came to lie a centimetre outside of its line.
"""


@dataclass(frozen=True, slots=True)
class Resolution:
    """The resolution of a simulation in space and time.

    Attributes:
        edge_m: the edge length of the mesh (m).
        step_s: the time step (s).
        iterations: iterations of the solvers of stiffness and of contacts at most; with 50, a folded strip slid by 2 mm
            more, with 20 by 4 mm.
        tolerance: the improvement at which they stop; T-shirt and hand towel folded at 1e-4 erred alike with 1e-5, on
            average within .7 mm but in their last folds (2 to 3 mm less), for five sixths of the time.
        rest_tolerance: the same while cloth that was let go comes to rest: to 1e-4 a vertex is wrong by up to .7 m/s2,
            and a stack at rest moves at 7 to 13 mm/s.
        settle_s: the time given to cloth to come to rest after it was released, at most (s); a robot that looks takes
            longer. A stack may lean over slowly before it falls.
    """

    edge_m: float = 0.02
    step_s: float = 0.008
    iterations: int = 200
    tolerance: float = 1e-4
    rest_tolerance: float = 1e-6
    settle_s: float = 3.0

    @staticmethod
    def of(area_m2: float) -> "Resolution":
        """Return the resolution for a cloth of some size: rows as near as it has points for.

        A crease takes a few rows to turn over. With rows 20 mm apart a small garment's stack leans and slides.
        """
        return Resolution(min(max(math.sqrt(area_m2 / _POINTS), _NEAREST_M), _FURTHEST_M))
