"""``toongeo landmarks``: landmarks placed and corrected by hand, with the fitted face beside them."""
