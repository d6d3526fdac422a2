"""The mesh of one tooth sector: a transverse section, swept along the helix."""
