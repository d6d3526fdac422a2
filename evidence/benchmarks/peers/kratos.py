"""Kratos' side of the benchmark: build/peers/bin/python -m evidence.benchmarks.peers.kratos TASK ANSWER

Augmented Lagrangian mortar contact without friction between cells of the first order, the linear systems by AMGCL in
3D and by a sparse LU in 2D. (With friction its pair of gears does not converge.) Writing its input counts as meshing.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from evidence.benchmarks.comparison.task import Answer, Push, Task
from evolvent_meshes.mesh.mesh_data import MeshData

ELEMENT = {"triangle": "2D3N", "quadrilateral": "2D4N", "tetrahedron": "3D4N", "hexahedron": "3D8N"}
SLAVE = 0  # with the multiplier on the smaller cells Newton diverges on the sphere
ITERATIONS = 40
LAW = {2: "LinearElasticPlaneStrain2DLaw", 3: "LinearElastic3DLaw"}
SOLVER = {
    2: {"solver_type": "LinearSolversApplication.sparse_lu"},
    3: {
        "solver_type": "amgcl", "smoother_type": "ilu0", "krylov_type": "gmres", "coarsening_type": "aggregation",
        "max_iteration": 500, "tolerance": 1e-8, "scaling": False,
    },
}


def main() -> None:
    source, target = Path(sys.argv[1]), Path(sys.argv[2])
    task, begin = Task.read(source), time.process_time()
    if not isinstance(task.drive, Push) or task.friction:
        raise ValueError("Kratos: wanted a frictionless push, found a pair of gears with friction")
    job = target.with_suffix("")
    job.with_suffix(".mdpa").write_text("\n".join(_model_lines(task)) + "\n")
    job.with_suffix(".materials.json").write_text(json.dumps(_materials(task)))
    written = time.process_time()
    answer = _solved(task, job)
    seconds = {"start": begin, "mesh": written - begin, "solve": time.process_time() - written}
    Answer(**{**vars(answer), "seconds": seconds}).write(target)


def _model_lines(task: Task) -> Iterator[str]:
    """The lines of the .mdpa file."""
    starts, first = (0, len(task.bodies[0].points)), (0, len(task.bodies[0].cells))
    yield from ("Begin Properties 0", "End Properties", "Begin Properties 1", "End Properties")
    yield from ("Begin Properties 2", "End Properties", "Begin Nodes")
    for mesh, start in zip(task.bodies, starts):
        yield from (f"{k} {x:.12g} {y:.12g} {z:.12g}" for k, (x, y, z) in enumerate(mesh.points.tolist(), start + 1))
    yield "End Nodes"
    for i, mesh in enumerate(task.bodies):
        yield f"Begin Elements SmallDisplacementElement{ELEMENT[mesh.shape]}"
        for number, cell in enumerate((mesh.cells + starts[i] + 1).tolist(), first[i] + 1):
            yield f"{number} {i + 1} {' '.join(map(str, cell))}"
        yield "End Elements"
    for i, mesh in enumerate(task.bodies):
        nodes = range(starts[i] + 1, starts[i] + len(mesh.points) + 1)
        yield from _part(f"Body{i}", nodes, range(first[i] + 1, first[i] + len(mesh.cells) + 1))
        yield from _part(f"Contact{i}", _nodes(mesh, task.contact[i], starts[i]), ())
    yield from _part("Driven", _nodes(task.bodies[0], task.driven, 0), ())
    for number, (body, group, _) in enumerate(task.held):
        yield from _part(f"Held{number}", _nodes(task.bodies[body], group, starts[body]), ())


def _nodes(mesh: MeshData, group: str, start: int) -> list[int]:
    return (np.unique(mesh.facets[group]) + start + 1).tolist()


def _part(name: str, nodes: Any, elements: Any) -> Iterator[str]:
    yield from (f"Begin SubModelPart {name}", "Begin SubModelPartNodes", *map(str, nodes), "End SubModelPartNodes")
    yield from ("Begin SubModelPartElements", *map(str, elements), "End SubModelPartElements", "End SubModelPart")


def _materials(task: Task) -> dict[str, Any]:
    law = f"KratosMultiphysics.StructuralMechanicsApplication.{LAW[task.dimension]}"
    return {
        "properties": [
            {
                "model_part_name": f"Structure.Body{i}",
                "properties_id": i + 1,
                "Material": {
                    "constitutive_law": {"name": law},
                    "Variables": {"YOUNG_MODULUS": young, "POISSON_RATIO": poisson, "THICKNESS": 1.0},
                    "Tables": {},
                },
            }
            for i, (young, poisson) in enumerate(task.materials)
        ]
    }


def _settings(task: Task, job: Path) -> dict[str, Any]:
    """Of Kratos' structural analysis."""
    d = task.dimension
    push = [0.0, 0.0, 0.0]
    push[d - 1] = task.drive.displacement if isinstance(task.drive, Push) else 0.0
    supports = [_fixed("Driven", "xyz", push)]
    supports += [_fixed(f"Held{k}", directions, [0.0] * 3) for k, (_, _, directions) in enumerate(task.held)]
    return {
        "problem_data": {
            "problem_name": job.name, "parallel_type": "OpenMP", "start_time": 0.0, "end_time": 1.0, "echo_level": 0
        },
        "solver_settings": {
            "solver_type": "Static",
            "model_part_name": "Structure",
            "domain_size": d,
            "echo_level": 0,
            "analysis_type": "non_linear",
            "model_import_settings": {"input_type": "mdpa", "input_filename": str(job)},
            "material_import_settings": {"materials_filename": str(job.with_suffix(".materials.json"))},
            "time_stepping": {"time_step": 1.1},
            "contact_settings": {"mortar_type": "ALMContactFrictionless"},
            "clear_storage": False,
            "reform_dofs_at_each_step": True,
            "convergence_criterion": "contact_residual_criterion",
            "residual_relative_tolerance": 1e-6,
            "residual_absolute_tolerance": 1e-9,
            "max_iteration": ITERATIONS,
            "linear_solver_settings": SOLVER[d],
        },
        "processes": {
            "constraints_process_list": supports,
            "contact_process_list": [
                {
                    "python_module": "alm_contact_process",
                    "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
                    "process_name": "ALMContactProcess",
                    "Parameters": {
                        "model_part_name": "Structure",
                        "contact_model_part": {"0": ["Contact0", "Contact1"]},
                        "assume_master_slave": {"0": [f"Contact{SLAVE}"]},
                        "contact_type": "Frictionless",
                    },
                }
            ],
        },
    }


def _fixed(part: str, directions: str, value: list[float]) -> dict[str, Any]:
    return {
        "python_module": "assign_vector_variable_process",
        "kratos_module": "KratosMultiphysics",
        "process_name": "AssignVectorVariableProcess",
        "Parameters": {
            "model_part_name": f"Structure.{part}",
            "variable_name": "DISPLACEMENT",
            "constrained": [a in directions for a in "xyz"],
            "value": [v if a in directions else None for a, v in zip("xyz", value)],
            "interval": [0.0, "End"],
        },
    }


def _solved(task: Task, job: Path) -> Answer:
    """Runs the analysis. Raises RuntimeError where it does not converge."""
    import KratosMultiphysics as KM
    import KratosMultiphysics.ContactStructuralMechanicsApplication as CSMA
    import KratosMultiphysics.LinearSolversApplication  # registers its solvers
    from KratosMultiphysics.StructuralMechanicsApplication.structural_mechanics_analysis import (
        StructuralMechanicsAnalysis,
    )

    model = KM.Model()
    analysis = StructuralMechanicsAnalysis(model, KM.Parameters(json.dumps(_settings(task, job))))
    analysis.Run()
    part = model["Structure"]
    iterations = int(part.ProcessInfo[KM.NL_ITERATION_NUMBER])
    if iterations >= ITERATIONS:
        raise RuntimeError(f"Kratos: no convergence within {ITERATIONS} iterations")
    slave = task.bodies[SLAVE]
    nodes = np.unique(slave.facets[task.contact[SLAVE]])
    offset = len(task.bodies[0].points) if SLAVE else 0
    scale = part.ProcessInfo[KM.SCALE_FACTOR]
    pressure = [
        -scale * part.Nodes[int(k) + offset + 1].GetSolutionStepValue(CSMA.LAGRANGE_MULTIPLIER_CONTACT_PRESSURE)
        for k in nodes
    ]
    return Answer(SLAVE, np.array(pressure), nodes, iterations=iterations, dofs=task.dofs)


if __name__ == "__main__":
    main()
