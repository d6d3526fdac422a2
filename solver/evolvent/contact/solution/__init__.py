"""Solution of contact problems: steps, sweeps, reactions, fields for ParaView."""
