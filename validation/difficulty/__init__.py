"""How hard it is to tell a rub from no rub by what the sensors record."""
