"""Exaggerated faces: a deformation space that extrapolates (Wu et al. 2018, "Alive caricature from 2D to 3D")."""
