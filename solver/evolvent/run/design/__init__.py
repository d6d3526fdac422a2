"""Flank modifications that vary, each variant in line contact on the same condensed gears (docs/flank_design.md)."""
