"""Tooth root stress by ISO 6336-3 and by formulas from papers, without computing the gears."""
