"""What results cost, measured."""
