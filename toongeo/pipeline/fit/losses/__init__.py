"""Terms of the loss, and the minimiser."""
