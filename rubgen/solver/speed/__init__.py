"""How a run starts, and how the scheme is taken through its turns at a steady or at a changing speed."""
