"""What every reader of files promises, below all of them: see `promise`."""
