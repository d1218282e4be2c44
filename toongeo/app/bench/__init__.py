"""``toongeo bench``: the tables of Pan et al. 2024 and of Wu et al. 2018 on a folder of pictures."""
