"""What several figures draw in the same way."""
