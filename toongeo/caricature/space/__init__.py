"""The deformation space that extrapolates (Wu et al. 2018)."""
