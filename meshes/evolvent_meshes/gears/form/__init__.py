"""What makes the form of a tooth and holds its body: tip of the rack, edge of the tip, support."""
