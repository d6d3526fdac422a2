"""What the results of Evolvent are worth and what they cost: problems, measurements, and the pages that report them."""
