"""The page that moves while weights come in."""
