"""How an avatar looks in files: lit or not, closed below, coloured at its vertices."""
