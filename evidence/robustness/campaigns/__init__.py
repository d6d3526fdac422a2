"""Random scenes and wear studies, solved by the hundred."""
