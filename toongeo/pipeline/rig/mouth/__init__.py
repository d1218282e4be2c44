"""Lips in contact, teeth behind them."""
