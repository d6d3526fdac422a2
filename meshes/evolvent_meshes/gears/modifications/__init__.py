"""What a drawing gives beside a gear's data: flank modifications, and how the body is held."""
