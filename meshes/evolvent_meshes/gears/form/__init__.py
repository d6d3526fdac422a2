"""Form of a tooth and support of its body: tip of the rack, edge of the tip, support."""
