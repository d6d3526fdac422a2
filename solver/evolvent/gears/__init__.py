"""The gears of a pair, condensed once for all positions."""
