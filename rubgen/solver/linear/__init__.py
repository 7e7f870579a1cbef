"""What the linear system says before a run: its forces, its motion without rub, its stability, its admissibility."""
