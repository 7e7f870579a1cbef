"""Choose the runs of a recipe with `[balance]`: screen candidates until one is in the class that is wanted."""
