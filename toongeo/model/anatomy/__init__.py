"""What follows from a template alone: rims, rings of the lids, the lip line, still vertices, sides."""
