"""Arrays for kernels that are tested alone; what a kernel must write before it reads it is NaN."""

import numpy as np

from rubgen.solver.scheme.model import new_contact_work


def contact_work(blades, modes=0):
    """Arrays of a contact step of so many blades and casing modes."""
    work = new_contact_work(3 * blades, modes)
    for array in work:
        if array.dtype.kind == "f":
            array.fill(np.nan)
    return work
