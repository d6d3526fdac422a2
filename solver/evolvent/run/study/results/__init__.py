"""What a study gives: records of scenes, figures, table and pictures."""
