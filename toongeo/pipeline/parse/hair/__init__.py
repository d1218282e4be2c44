"""How hair is found: superpixels, their features, boosted trees, cuts, rules of growth, and when to believe a mask."""
