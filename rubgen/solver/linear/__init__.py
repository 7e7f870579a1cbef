"""The linear system before a run: its motion without rub, its stability, whether it can be integrated."""
