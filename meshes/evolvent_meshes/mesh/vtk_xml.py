"""VTK's XML files, made in memory: VTK itself crashes where it writes to a full disk."""

from __future__ import annotations

from typing import Any


def xml_bytes(writer: Any, data: Any) -> bytes:
    """The content of the file that a writer of VTK's makes of a data set. Raises RuntimeError where it cannot."""
    writer.SetInputData(data)
    writer.WriteToOutputStringOn()
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOn()
    if not writer.Write():
        raise RuntimeError(f"fields: wanted VTK's XML of a {data.GetClassName()}, found that VTK could not make it")
    return str(writer.GetOutputString()).encode()
