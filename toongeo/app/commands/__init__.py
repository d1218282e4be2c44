"""Arguments of the commands, and what is common to all."""
