"""XML files of VTK, made in memory: VTK crashes where it writes to a full disk."""

from __future__ import annotations

from typing import Any


def xml_bytes(writer: Any, data: Any) -> bytes:
    """The content of a file as a VTK writer writes it. Raises RuntimeError where VTK fails.

    writer: vtkXMLWriter of the type of the data.
    data: VTK data set.
    """
    writer.SetInputData(data)
    writer.WriteToOutputStringOn()
    writer.SetDataModeToAppended()
    writer.SetCompressionLevel(1)  # of zlib: five times as fast as VTK's 5, for files 3 % larger
    writer.EncodeAppendedDataOn()
    if not writer.Write():
        raise RuntimeError(f"fields: wanted VTK's XML of a {data.GetClassName()}, found that VTK could not make it")
    return str(writer.GetOutputString()).encode()
