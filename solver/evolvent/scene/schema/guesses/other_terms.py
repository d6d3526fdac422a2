"""Words for material, load, friction, mesh, wear, vibration, strength and output."""

from __future__ import annotations

from evolvent.scene.schema.guesses.terms import Term

FEM = "finite element programs"
TOOLS = "gear programs"
SIZE = "cells are that many times shorter than the Hertz width 2b_H, which `evolvent check` prints"
OF_LIST = "a section [[load_case]] for each load"
COMMAND_LINE = "folders and files are named on the command line: --out DIR"

OTHER_TERMS: tuple[Term, ...] = (
    # material
    Term("youngs_modulus young_modulus young young's_modulus elastic_modulus modulus_of_elasticity elasticity_modulus "
         "modulus e_modulus emodulus e_modul emodul material.e", ("material.E_GPa",), source=FEM),
    Term("poisson poissons_ratio poisson_ratio poisson's_ratio poisson_number material.v querkontraktionszahl",
         ("material.nu",), source=FEM),
    Term("shear_modulus g_modulus material.g", (), "the shear modulus follows from E_GPa and nu", FEM),
    Term("density rho material_density mass_density", ("dynamics.density_kg_m3",), source=FEM),
    Term("material.name material.material material.type gear.material steel", (),
         "there is no list of materials: give material.E_GPa and material.nu"),
    Term("yield yield_stress yield_strength yield_point sigma_y rp02 rp0_2", ("fatigue.yield_stress_MPa",),
         "a run itself is linearly elastic", FEM),
    Term("gear.e", ("material.E_GPa",), "of one gear in [material.pinion] or [material.wheel]"),
    Term("gear.nu", ("material.nu",), "of one gear in [material.pinion] or [material.wheel]"),
    # load and friction
    Term("load.t load.t_nom t_nom tnom t1 t_1 torque moment drehmoment nominal_torque input_torque "
         "pinion_torque", ("load.torque_Nm",),
         "on the gear that load.on names"),
    Term("output_torque wheel_torque gear_torque t2 t_2", ("load.torque_Nm",), 'with load.on = "wheel"'),
    Term("force tangential_force transverse_force f_t ft load.f nominal_force", ("load.torque_Nm",),
         "T = F_t d/2 at the reference diameter d", "ISO 6336-1"),
    Term("normal_force f_bn f_n fn", ("load.torque_Nm",), "T = F_bn r_b cos β_b at the base radius r_b",
         "ISO 21771:2007"),
    Term("line_load specific_load w w_t", ("load.torque_Nm",), "T = w b d/2 of a tangential line load w", "AGMA 2001"),
    Term("application_factor k_a ka overload_factor load_factor service_factor", ("load.torque_Nm",),
         "multiply the torque by the factor", "ISO 6336-1"),
    Term("load.cases load.case load.load_cases load.duty_cycle load.spectrum load.torques load.list",
         ("load_case", "load.percents"), "absolute torques in sections [[load_case]], or percents of load.torque_Nm"),
    Term("load_case.rpm load_case.n load_case.n1 load_case.n_1 load_case.omega", ("load_case.speed_rpm",),
         "of the pinion"),
    Term("load_case.share load_case.time_share load_case.q load_case.weight load_case.fraction load_case.probability "
         "load_case.duration load_case.hours load_case.time load_case.cycles", ("load_case.share_of_life",),
         "over the whole life"),
    Term("load_case.title load_case.id load_case.label", ("load_case.name",)),
    Term("torque_on loaded_gear torque_gear load.gear load.side", ("load.on",)),
    Term("driver driving drives driving_gear driving_member driven driven_gear drive_gear input_gear input input_on "
         "output_gear driving_wheel power_flow load.direction sweep.direction sense_of_rotation direction_of_rotation "
         "rotation_direction rotation_sense turning_direction load.reverse reversed load.coast speed_increaser step_up",
         ("load.driving",), "the flanks that bear are the same"),
    Term("mu friction friction_coefficient coefficient_of_friction cof coulomb friction_factor contact.coefficient "
         "reibungszahl static_friction dynamic_friction", ("contact.friction",), source=FEM),
    Term("penalty penalty_factor penalty_stiffness contact_stiffness nitsche gamma contact_tolerance augmentation "
         "contact_algorithm contact.method contact.formulation", (),
         "contact has no parameters: those of Nitsche's method follow from the mesh", FEM),
    Term("stribeck hertz_damping", (), "friction is Coulomb's, with one coefficient for stick and slip"),
    # mesh and positions
    Term("mesh.size mesh.h element_size mesh_size cell_size max_size seed_size global_size flank_element_size "
         "mesh.seed contact_element_size", ("mesh.elements_per_contact_width",), SIZE, FEM),
    Term("mesh.elements number_of_elements n_elements elements_per_contact elements_per_width elements_across "
         "mesh.refinement", ("mesh.elements_per_contact_width",), SIZE, FEM),
    Term("mesh.type mesh.cells mesh.cell mesh.element element_type cell_type element_shape cell_shape", ("mesh.shape",),
         source=FEM),
    Term("mesh.degree element_order polynomial_order polynomial_degree interpolation_order", ("mesh.order",),
         source=FEM),
    Term("level mesh.quality fineness mesh_level mesh.density resolution mesh.accuracy", ("mesh.level",), source=TOOLS),
    Term("number_of_positions n_positions num_positions sweep.steps sweep.n sweep.increments number_of_steps "
         "sweep.points rotation_steps positions mesh_positions", ("sweep.positions",), source=TOOLS),
    Term("start_angle end_angle sweep.range sweep.angle rotation_angle sweep.pitches sweep.start sweep.end", (),
         "one angular pitch is solved; the whole engagement of a tooth is assembled from it"),
    # wear
    Term("wear.coefficient wear.k wear_coefficient archard_coefficient archard wear_rate specific_wear_rate "
         "wear.k_h dimensionless_wear_coefficient", ("wear.pinion_mm2_per_N", "wear.wheel_mm2_per_N"),
         "K/H in mm²/N: a rate in mm³/(N·m) divided by 1000, a coefficient without unit divided by the hardness in "
         "MPa"),
    Term("cycles revolutions number_of_cycles n_cycles num_cycles load_cycles wear.n wear.turns", ("wear.cycles",)),
    Term("hours operating_hours service_life running_time", ("wear.cycles",), "60 times hours times r/min"),
    Term("reports report_cycles output_cycles write_interval report_at", ("wear.report_at_cycles",), source=FEM),
    Term("wear.step wear.increment wear.block block_cycles cycle_increment cycle_jump", ("wear.first_block_cycles",)),
    Term("remesh remeshing remeshing_depth", ("wear.refresh_um",), source=FEM),
    # vibration
    Term("dynamics.damping dynamics.zeta dynamics.xi mesh_damping damping_factor viscous_damping critical_damping "
         "damping_coefficient", ("dynamics.damping_ratio",), "over the critical damping"),
    Term("transient.damping modal_damping mode_damping transient.zeta structural_damping",
         ("transient.mode_damping_ratio",), "of the gears' modes; that of the mesh is dynamics.damping_ratio"),
    Term("dynamics.rpm dynamics.speed dynamics.n dynamics.n1 speed_range rotational_speed pinion_speed input_speed "
         "dynamics.frequency rpm_range", ("dynamics.speed_rpm",), "the lowest and the highest one, of the pinion"),
    Term("transient.rpm transient.speed transient.n transient.n1 transient.omega transient.speed_rpm "
         "transient.operating_rpm", ("transient.speeds_rpm",), "a list, of the pinion"),
    Term("dynamics.speeds_rpm", ("dynamics.speed_rpm", "dynamics.operating_rpm", "transient.speeds_rpm"),
         "of the pinion: the range of `evolvent dynamics`, one speed of `evolvent run`, a list for `evolvent "
         "transient`"),
    Term("load.speed load.speeds load.rpm load.n load.n1 load.n_1 load.omega",
         ("dynamics.operating_rpm", "transient.speeds_rpm"),
         "of the pinion: one speed of `evolvent run`, a list for `evolvent transient`"),
    Term("number_of_speeds n_speeds speed_steps speed_points", ("dynamics.speeds",)),
    Term("dynamics.torques dynamics.loads load_percents torque_levels percents", ("dynamics.torque_percents",)),
    Term("inertia moment_of_inertia dynamics.j dynamics.i polar_moment", (
        "dynamics.pinion_inertia_kg_m2", "dynamics.wheel_inertia_kg_m2")),
    Term("j1 i1 j_1 pinion_inertia", ("dynamics.pinion_inertia_kg_m2",)),
    Term("j2 i2 j_2 wheel_inertia gear_inertia", ("dynamics.wheel_inertia_kg_m2",)),
    Term("mass gear_mass equivalent_mass", ("dynamics.pinion_inertia_kg_m2", "dynamics.wheel_inertia_kg_m2"),
         "moments of inertia are asked for; by default they follow from geometry and density"),
    Term("dynamics.stiffness series_stiffness bearing_stiffness shaft_stiffness support_stiffness",
         ("dynamics.series_stiffness_N_per_um",), "along the line of action"),
    Term("mesh_stiffness c_gamma c_gamma_alpha c_prime tooth_stiffness", (),
         "mesh stiffness is computed: `evolvent excitation`", "ISO 6336-1"),
    Term("dynamics.direction speed_direction run_direction", ("dynamics.approach",)),
    Term("f_pb fpb base_pitch_error base_pitch_deviation f_pt fpt", ("dynamics.base_pitch_deviation_um",),
         "f_pb = f_pt cos α_t, for K_v of ISO 6336-1", "ISO 1328-1"),
    Term("f_f_alpha f_falpha ffa profile_form_deviation profile_error", ("dynamics.profile_deviation_um",),
         "for K_v of ISO 6336-1", "ISO 1328-1"),
    Term("quality gear.q pair.q accuracy_grade accuracy_class iso_quality quality_grade iso_grade dynamics.grade "
         "strength.grade "
         "flank_tolerance_class", ("strength.tolerance_class", "dynamics.tolerance_class"),
         "for the formulas of ISO 6336 alone: flanks are computed without deviations", "ISO 1328-1"),
    Term("sigma_hlim sigma_h_lim shlim contact_endurance contact_stress_limit allowable_contact_stress",
         ("dynamics.contact_endurance_MPa",), "for running-in in K_v of ISO 6336-1", "ISO 6336-5"),
    Term("heat_treatment hardening surface_treatment surface_hardening", ("dynamics.flank_surface",),
         "for running-in in K_v of ISO 6336-1", "ISO 6336-5"),
    Term("time_step timestep dt step_size transient.steps transient.positions", ("sweep.positions",),
         "a time step leads from one of the positions to the next; transient.tolerance divides it", FEM),
    Term("end_time final_time duration total_time transient.time transient.periods number_of_periods transient.cycles",
         ("transient.mesh_periods",), "in mesh periods, at most", FEM),
    Term("modes number_of_modes n_modes num_modes mode_count", ("transient.modes_per_harmonic",), source=FEM),
    Term("rho_inf rho_infinity transient.alpha numerical_damping high_frequency_dissipation",
         ("transient.spectral_radius",), source=FEM),
    Term("max_parts subdivisions transient.substeps", ("transient.most_parts",), "with transient.tolerance", FEM),
    # strength and fatigue
    Term("strength.edition strength.standard strength.iso strength.iso_edition", ("strength.editions",)),
    Term("strength.refinement root_elements fillet_refinement fillet_elements", ("strength.root_refinement",)),
    Term("strength.gauge strain_gauges strain_gages gages", ("strength.gauges",)),
    Term("fatigue.depth depth_list", ("fatigue.depths",), "over the half-width of the contact"),
    Term("dang_van dang_van_factor alpha_dv fatigue.a fatigue.alpha", ("fatigue.tension_factor",)),
    Term("fatigue.k fatemi_socie fatemi_socie_factor", ("fatigue.normal_factor",)),
    Term("fatigue.m slope slopes sn_slope woehler_exponent wöhler_exponent basquin", ("fatigue.exponents",)),
    # output
    Term("plots figures images output.png plot draw pics", ("output.pictures",)),
    Term("output.gif video movie animate", ("output.animation",)),
    Term("vtk vtu paraview output.results field_output", ("output.fields",), source=FEM),
    Term("displacement displacements deformed deformations stresses", ("output.deformation",), source=FEM),
    Term("uncertainty error_estimate error_bar output.errors", ("output.error_bars",)),
    Term("output.compare compare comparison", (), "a run shows its own results alone; the comparison with Yang et al. "
         "2022 is on docs/yang2022.md, by `python -m evidence.pages.papers.yang_figures OUT`"),
    Term("output.folder output.dir output.directory output.path output.file output.out output_folder output_dir outdir",
         (), COMMAND_LINE),
    Term("pictures", ("output.pictures",)), Term("animation", ("output.animation",)), Term("fields",
         ("output.fields",)),
    Term("no_skip exact.names exact.off exact.skip skips", ("exact.parts",)),
    Term("name description comment project author", ("title",)),
    Term("threads cores ranks processes n_cpus cpus parallel", (), "ranks are those of mpirun -n on the command line"),
    Term("version schema_version format units unit_system", (), "a scene has none: units are in the names of its keys"),
)

SECTION_TERMS: tuple[Term, ...] = (
    Term("gear gear2 gear_2 driven driven_gear wheel_gear gearwheel bull_gear output_gear large_gear gear_b",
         ("wheel",)),
    Term("gear1 gear_1 driver driving driving_gear drive_gear input_gear small_gear pinion_gear gear_a", ("pinion",)),
    Term("gears geometry gear_pair gearpair toothing gear_data gear_geometry basic_data", ("pair",)),
    Term("materials material_data", ("material",)), Term("coulomb friction contact_pair interaction", ("contact",)),
    Term("loads loading", ("load",)),
    Term("load_cases loadcase loadcases case cases duty_cycle dutycycle duty load_spectrum spectrum load_collective "
         "collective operating_conditions operating_points operating_point", ("load_case",), OF_LIST),
    Term("fe fem fea meshing discretization discretisation", ("mesh",)),
    Term("steps kinematics rotation", ("sweep",)), Term("archard", ("wear",)),
    Term("vibration nvh dynamic", ("dynamics",)), Term("time_domain impact", ("transient",)),
    Term("root_stress bending iso6336 iso_6336 rating", ("strength",)), Term("pitting contact_fatigue", ("fatigue",)),
    Term("outputs results postprocessing", ("output",)), Term("skips skip no_skip", ("exact",)),
    Term("material.gear material.gear2 material.gear_2 material.driven", ("material.wheel",)),
    Term("material.gear1 material.gear_1 material.driver material.driving", ("material.pinion",)),
    Term("gear.material pair.material", (),
         "materials are [material], [material.pinion] and [material.wheel]"),
    Term("modifications microgeometry micro_geometry flank_modifications profile_modifications", ("pinion", "wheel"),
         "modifications are keys of the gears"),
    Term("rack rack_profile basic_rack reference_profile", (),
         "a rack as a gear is not supported; the basic rack of a gear has keys in [pinion] and [wheel], such as "
         "addendum_coefficient and dedendum_coefficient"),
    Term("solver analysis petsc linear_solver newton", (), "solvers have no settings in a scene"),
)

LIST_TERMS: tuple[Term, ...] = (Term("loads loading", ("load_case",), OF_LIST),)
"""Words for lists of sections that are those of another section where there is one."""

STUDY_TERMS: tuple[Term, ...] = (
    Term("base base_scene scene_file base_file", ("scene",)),
    Term("command computation task calculate", ("compute",)),
    Term("parameters variables factors full_factorial factorial sweep vary", ("grid",)),
    Term("table rows points pairs zip", ("list",)),
    Term("samples lhs doe random sampling monte_carlo latin_hypercube_sampling", ("latin_hypercube",)),
    Term("overrides settings constants fixed common", ("set",)),
    Term("outputs results responses quantities", ("figures",)),
    Term("exclude without drop remove omit", ("leave_out",)),
    Term("name description project", ("title",)),
    Term("workers processes threads parallel jobs", (), "workers are given on the command line: --workers N"),
)
"""Words of users for the keys and sections of study files."""
