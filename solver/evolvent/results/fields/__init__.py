"""Fields on flanks and in teeth, and their files for ParaView."""
