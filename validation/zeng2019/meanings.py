"""The causes of a statement that differs, and what each name means."""

from __future__ import annotations

SYMMETRY = "the paper contradicts symmetry"
FRAMES_MIXED = "mixed frames"
REDUCTION = "tolerance of a reduction"
GEOMETRY = "contact geometry"
DIMENSION = "a lost dimension"
BOUND = "bound of a label"
WORDS = "reading of the words"
UNKNOWN = "not found"
MEANINGS = {
    SYMMETRY: "A machine whose blades are equal and whose casing has two equal lobes cannot do it.",
    FRAMES_MIXED: "A consistent model cannot do it, a model with blades in turning and the disk in inertial axes does.",
    REDUCTION: "The reduced basis is less accurate than the paper says, or its limit is another one than ours.",
    GEOMETRY: "Chords agree, and the same machine on the smooth curve does not.",
    DIMENSION: "Another value of what is not published agrees: mass, springs, damping or friction.",
    BOUND: "Another bound between two classes agrees, such as the eye's.",
    WORDS: "Another reading of the paper's sentence agrees, such as with the tips or at the values it names.",
    UNKNOWN: "No experiment of this page agrees.",
}
