"""A gear whose flanks are finer than its body: what fine cells change, strip by strip along the face."""
