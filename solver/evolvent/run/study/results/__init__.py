"""Results of a study: records of scenes, figures, table and pictures."""
