"""The paper's conclusions, and what explains them."""
