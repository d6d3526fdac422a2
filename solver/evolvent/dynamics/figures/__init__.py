"""Pictures of a pair's excitation and vibration."""
