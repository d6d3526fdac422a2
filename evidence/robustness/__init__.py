"""Settings at the edge of their range, random scenes and wear studies, faults."""
