"""``toongeo bench``: the tables of Pan et al. 2024 on a folder of pictures."""
