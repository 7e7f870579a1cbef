"""The constants of a step: laws and limits, tables over the angle, and the whole model."""

from typing import NamedTuple

from rubgen.arrays import FloatArray, IntArray
from rubgen.contact.geometry_kernels import Surface, Tips
from rubgen.linalg.block_kernels import Product
from rubgen.linalg.harmonic_kernels import Harmonics
from rubgen.solver.scheme.free_step_kernels import Scheme
from rubgen.solver.supports.support_kernels import Support


class Laws(NamedTuple):
    """The numbers of a step: speed, time step, contact law, and the limits within which it is valid."""

    speed: float
    """Omega, rad/s."""
    dt: float
    """Time step, s."""
    friction: float
    """Coefficient of Coulomb friction."""
    restitution: float
    """Coefficient of restitution of the contact."""
    normal: FloatArray
    """The law of the normal force: its number in the registry, and the constants that its `NormalLaw.respond` takes."""
    regards_rate: bool
    """Whether contact takes gaps at step n - 1: with restitution, and with a law that regards the rate."""
    margin: float
    """The least distance within which blades are solved together, m."""
    casing_limit: float
    """A casing node displaced by more than this has diverged, m."""
    tip_limit: float
    """A blade tip displaced by more than this in one direction has diverged, m."""
    tip_shift: float
    """Largest distance of a tip from its place at rest along either axis before it diverges, tip radii."""
    lasting: bool
    """Whether gaps are needed again in later steps where no blade touches: `regards_rate`, or a liner."""
    screen: bool
    """Whether bounds of the clearance are taken before gaps."""


class Angles(NamedTuple):
    """Tables over the steps of a turn or part of a turn: rows for steps 0, ..., steps, and last for step -1."""

    theta: FloatArray
    """Angle of the blisk (steps + 2,), rad."""
    cosine: FloatArray
    """Cosine of theta (steps + 2,)."""
    sine: FloatArray
    """Sine of theta (steps + 2,)."""
    cos_orders: FloatArray
    """Cosine of order_j (theta - phase_j) (steps + 2, n_harmonics), order and phase as in `Surface`."""
    sin_orders: FloatArray
    """Sine of the same angles (steps + 2, n_harmonics)."""
    section: float
    """Time from step 0 to theta = 0 mod 2 pi, in steps, between -1/2 and 1/2."""


class EnergyTerms(NamedTuple):
    """The matrices of the energy terms, in blocks."""

    damping: Product
    """The lower triangle of C_sym with half its diagonal, so that d^T C d = 2 d^T (triangle d)."""
    circulatory: Product
    """K_skew; without lines where `circulatory_pairs` hold it."""
    circulatory_pairs: FloatArray
    """K_skew as the sum of a b^T - b a^T over pairs of vectors a, b (pairs, 2, any); no pairs where `circulatory` holds
    it."""
    M: Product
    """The symmetric part of M."""
    K: Product
    """The symmetric part of K."""
    force: FloatArray
    """The numbers of the unbalance force that are not zero, N."""
    force_places: IntArray
    """Their indices in z."""
    waits: bool
    """Whether works wait until those of several steps are computed at once: large matrices are read once for all."""


class Model(NamedTuple):
    """All constants of the steps. The arrays are read-only."""

    surface: Surface
    """The casing's inner surface."""
    tips: Tips
    """The blade tips."""
    laws: Laws
    """Time step and contact law."""
    angles: Angles
    """Tables over the angle."""
    scheme: Scheme
    """Matrices of the step without contact."""
    harmonics: Harmonics
    """From z to tip coordinates."""
    tip_compliance: FloatArray
    """The columns of A^-1 between tip coordinates (3 blades, 3 blades), m/N."""
    casing_compliance: FloatArray
    """The columns of A^-1 of the casing modes (n_casing, n_casing)."""
    support: Support
    """Uneven supports, squeeze film and gravity."""
    energy: EnergyTerms
    """Matrices of the energy terms."""
