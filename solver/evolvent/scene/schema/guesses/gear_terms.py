"""Words for the geometry of gears and their flanks. Symbols are those of the standards, spelled in Latin letters."""

from __future__ import annotations

from evolvent.scene.schema.guesses.terms import Term

ISO = "ISO 21771:2007"
AGMA = "AGMA 1012"
TOOLS = "gear programs"
ROLL = "the diameter, d = 2 √(r_b² + ρ²) at the roll length ρ where it begins"
OF_MODULE = "over the normal module: divide a length by it"

GEAR_TERMS: tuple[Term, ...] = (
    # numbers that both gears share
    Term("module normal_modul modul m_n mn pair.m module_normal", ("pair.normal_module_mm",), source=ISO),
    Term("transverse_module m_t mt face_module", ("pair.normal_module_mm",), "m_n = m_t cos β", ISO),
    Term("diametral_pitch normal_diametral_pitch p_nd pnd p_d dp", ("pair.normal_module_mm",),
         "25.4/P_nd; of a transverse diametral pitch 25.4 cos β/P_d", AGMA),
    Term("transverse_diametral_pitch", ("pair.normal_module_mm",), "25.4 cos β/P_d", AGMA),
    Term("circular_pitch normal_circular_pitch cp normal_pitch p_n", ("pair.normal_module_mm",),
         "m_n = p_n/π", AGMA),
    Term("alpha alpha_n alphan pressure_angle rack_angle profile_angle tool_angle eingriffswinkel pair.phi",
         ("pair.normal_pressure_angle_deg",), source=ISO),
    Term("alpha_t transverse_pressure_angle", ("pair.normal_pressure_angle_deg",), "tan α_n = tan α_t cos β", ISO),
    Term("alpha_wt working_pressure_angle operating_pressure_angle working_transverse_pressure_angle", (),
         "the working pressure angle follows from centre_distance_mm", ISO),
    Term("beta helix pair.spiral_angle pair.psi schraegungswinkel schrägungswinkel", ("pair.helix_angle_deg",),
         source=ISO),
    Term("beta_b base_helix_angle", ("pair.helix_angle_deg",), "sin β_b = sin β cos α_n", ISO),
    Term("pair.a a_w aw center_distance centre_distance axis_distance shaft_distance operating_center_distance "
         "working_center_distance operating_centre_distance working_centre_distance achsabstand",
         ("pair.centre_distance_mm",), source=ISO),
    Term("inclination deviation_error axis_deviation shaft_deviation mesh_misalignment equivalent_misalignment "
         "f_beta_x "
         "f_beta_y f_sh fsh fbx fby f_betax f_betay axis_misalignment shaft_misalignment parallelism "
         "parallelism_error skew "
         "tilt "
         "f_sigma_beta f_sigma_delta lead_mismatch pair.deviation", ("pair.misalignment_um",),
         "over the face width, in the plane of action: multiply an angle in rad there by the face width",
         "ISO 6336-1"),
    # one gear
    Term("gear.z teeth number_of_teeth tooth_number teeth_number tooth_count no_of_teeth num_teeth n_teeth zaehnezahl "
         "zähnezahl", ("gear.teeth",), source=ISO),
    Term("z1 z_1", ("pinion.teeth",), source=ISO), Term("z2 z_2", ("wheel.teeth",), source=ISO),
    Term("gear.x gear.x_n profile_shift addendum_modification addendum_modification_coefficient addendum_mod "
         "addendum_mod_coefficient "
         "profile_shift_coefficient profile_shift_factor rack_shift rack_shift_coefficient x_factor x_coefficient "
         "profilverschiebung profilverschiebungsfaktor profile_correction", ("gear.profile_shift",), OF_MODULE, ISO),
    Term("x1 x_1", ("pinion.profile_shift",), source=ISO), Term("x2 x_2", ("wheel.profile_shift",), source=ISO),
    Term("gear.b gear.width pair.b pair.width facewidth gear_width tooth_width zahnbreite breite effective_face_width "
         "active_face_width", ("gear.face_width_mm",), source=ISO),
    Term("b1 b_1", ("pinion.face_width_mm",), source=ISO), Term("b2 b_2", ("wheel.face_width_mm",), source=ISO),
    Term("d_a da tip_circle tip_circle_diameter outside_diameter outer_diameter addendum_diameter od "
         "addendum_circle_diameter major_diameter kopfkreisdurchmesser", ("gear.tip_diameter_mm",), source=ISO),
    Term("r_a ra tip_circle_radius outer_radius outside_radius addendum_radius", ("gear.tip_diameter_mm",),
         "twice the radius", ISO),
    Term("d_f df root_circle root_circle_diameter dedendum_diameter minor_diameter fusskreisdurchmesser",
         ("gear.root_diameter_mm",), source=ISO),
    Term("r_f rf root_circle_radius dedendum_radius", ("gear.root_diameter_mm",), "twice the radius", ISO),
    Term("h_ap hap h_a ha addendum addendum_factor h_a_star ha_star h_ap_star hap_star basic_rack_addendum",
         ("gear.addendum_coefficient",), OF_MODULE, "ISO 53"),
    Term("h_fp hfp h_f hf dedendum dedendum_factor h_f_star hf_star h_fp_star hfp_star basic_rack_dedendum",
         ("gear.dedendum_coefficient",), OF_MODULE, "ISO 53"),
    Term("clearance tip_clearance bottom_clearance root_clearance clearance_coefficient clearance_factor c_p c_star",
         ("gear.dedendum_coefficient",), "h_fP* = h_aP* + c/m_n: 1.25 has a clearance of 0.25 m_n", "ISO 53"),
    Term("rho_fp rhofp rho_f rho_fp_star rhofp_star fillet_radius root_radius root_fillet_radius fillet "
         "tool_tip_radius hob_tip_radius "
         "cutter_tip_radius rack_tip_radius_coefficient root_radius_factor fillet_radius_factor",
         ("gear.rack_tip_radius_mm",), "a coefficient is multiplied by the normal module", "ISO 53"),
    Term("protuberance_height protuberance_amount residual_protuberance s_pr spr pr grinding_allowance "
         "machining_allowance grinding_stock", ("gear.protuberance_um",), "s_pr = pr − q, less the stock q", ISO),
    Term("hand hand_of_helix helix_hand helix_direction hand_of_cut lead_direction flank_direction spiral_direction "
         "flankenrichtung", ("gear.hand",), source=ISO),
    Term("bore hole hole_diameter inner_diameter inside_diameter shaft_diameter gear.d_i gear.id bore_circle",
         ("gear.bore_diameter_mm",), source=TOOLS),
    Term("bore_radius inner_radius hole_radius shaft_radius", ("gear.bore_diameter_mm",), "twice the radius"),
    Term("gear.rim s_r sr rim_height", ("gear.rim_thickness_mm",), source="ISO 6336-1"),
    Term("gear.web b_s disc_thickness web_width", ("gear.web_thickness_mm",), source="ISO 6336-1"),
    Term("web_position web_shift", ("gear.web_offset_mm",)), Term("hub hub_outer_diameter", ("gear.hub_diameter_mm",)),
    Term("hub_radius", ("gear.hub_diameter_mm",), "twice the radius"),
    Term("support_length bearing_width shaft_length hub_length", ("gear.support_width_mm",)),
    Term("a_sn asn a_sne a_sni e_sns esns e_sni esni thickness_allowance tooth_thickness_tolerance "
         "tooth_thickness_deviation tooth_thinning "
         "thinning_for_backlash", ("gear.tooth_thickness_allowance_um",), "negative where teeth are thinner",
         "DIN 3967"),
    Term("chamfer h_k tip_edge_chamfer tip_edge_break", ("gear.tip_chamfer_um",), source=ISO),
    Term("tip_edge_radius tip_round tip_edge_rounding edge_rounding", ("gear.tip_rounding_um",), source=ISO),
    # the loaded flank
    Term("c_alpha_a c_aa caa ca_a ca c_a tip_relief_amount tip_relief_depth kopfruecknahme kopfrücknahme",
         ("gear.tip_relief_um",), source=ISO),
    Term("tip_relief_length tip_relief_start tip_relief_height start_of_tip_relief tip_relief_diameter d_ca l_ca dca "
         "lca "
         "tip_relief_roll_angle tip_relief_roll_length tip_relief_start_diameter",
         ("gear.tip_relief_start_diameter_mm",),
         ROLL, ISO),
    Term("tip_relief_type tip_relief_shape tip_relief_curve", ("gear.tip_relief_form",), source=TOOLS),
    Term("c_alpha_f c_af caf root_relief_amount root_relief_depth fussruecknahme fußrücknahme",
         ("gear.root_relief_um",),
         source=ISO),
    Term("root_relief_length root_relief_start root_relief_end root_relief_height root_relief_diameter d_cf_r l_cf lcf "
         "root_relief_roll_angle", ("gear.root_relief_end_diameter_mm",), ROLL, ISO),
    Term("root_relief_type root_relief_shape root_relief_curve", ("gear.root_relief_form",), source=TOOLS),
    Term("c_alpha calpha barrelling barreling profile_barrelling profile_barreling involute_crowning profile_crown "
         "involute_barrelling", ("gear.profile_crowning_um",), source=ISO),
    Term("c_h_alpha c_halpha cha pressure_angle_modification pressure_angle_correction profile_angle_modification "
         "involute_slope profile_angle_correction", ("gear.profile_slope_um",), source=ISO),
    Term("f_h_alpha f_halpha fha profile_slope_deviation pressure_angle_error", ("gear.profile_slope_um",),
         "C_Hα = −f_Hα cos β_b", "ISO 1328-1"),
    Term("c_beta cbeta crowning crown lead_crown longitudinal_crowning face_crowning helix_crowning helix_crown "
         "flank_line_crowning breitenballigkeit", ("gear.lead_crowning_um",), source=ISO),
    Term("c_h_beta c_hbeta chb helix_angle_modification helix_modification helix_correction lead_slope lead_correction "
         "lead_angle_modification lead_modification taper", ("gear.helix_slope_um",), source=ISO),
    Term("f_h_beta f_hbeta fhb helix_slope_deviation lead_error", ("gear.helix_slope_um",),
         "C_Hβ = −f_Hβ cos β_b of right-hand gears, f_Hβ cos β_b of left-hand ones", "ISO 1328-1"),
    Term("c_beta_i c_beta_ii end_relief_i end_relief_ii face_end_relief side_relief end_relief_amount endruecknahme "
         "endrücknahme",
         ("gear.end_relief_um",), source=ISO),
    Term("end_relief_width end_relief_start l_ci l_cii", ("gear.end_relief_length_mm",), source=ISO),
    Term("end_relief_type end_relief_shape end_relief_curve", ("gear.end_relief_form",), source=TOOLS),
    Term("s_alpha bias flank_twist bias_modification verschraenkung verschränkung", ("gear.twist_um",), source=ISO),
    Term("d_cf dcf control_diameter start_of_evaluation", ("gear.profile_control_diameter_mm",), source="ISO 1328-1"),
    Term("flank_chart flank_file chart measured_flank topography_csv", ("gear.flank_csv",), source=TOOLS),
    # what follows from these
    Term("ratio gear_ratio transmission_ratio speed_ratio reduction_ratio pair.u pair.i uebersetzung übersetzung", (),
         "the ratio follows from pinion.teeth and wheel.teeth", ISO),
    Term("contact_ratio transverse_contact_ratio overlap_ratio total_contact_ratio epsilon epsilon_alpha epsilon_beta "
         "epsilon_gamma profile_contact_ratio", (),
         "contact ratios follow from the geometry; `evolvent check` has them",
         ISO),
    Term("gear.d pitch_diameter reference_diameter pitch_circle pitch_circle_diameter pcd pitch_radius "
         "reference_radius "
         "reference_circle teilkreisdurchmesser", (),
         "d = z m_n/cos β follows from teeth, normal_module_mm and helix_angle_deg", ISO),
    Term("d_b db base_diameter base_radius base_circle r_b rb grundkreisdurchmesser", (),
         "d_b = d cos α_t follows from teeth, module, pressure angle and helix angle", ISO),
    Term("d_w dw working_pitch_diameter operating_pitch_diameter working_pitch_radius", (),
         "working pitch diameters follow from centre_distance_mm and the numbers of teeth", ISO),
    Term("tooth_thickness normal_tooth_thickness chordal_thickness span_measurement s_n sn w_k measurement_over_pins "
         "measurement_over_balls", (),
         "tooth thickness follows from profile_shift and tooth_thickness_allowance_um", ISO),
    Term("tooth_depth tooth_height whole_depth working_depth", (),
         "tooth depth follows from tip_diameter_mm and root_diameter_mm, or from the coefficients of the basic rack",
         ISO),
    Term("lead p_z axial_pitch p_x base_pitch transverse_base_pitch p_bt p_et", (),
         "leads and pitches follow from module, teeth, pressure angle and helix angle", ISO),
    Term("form_diameter tip_form_diameter d_fa dfa", (), "d_Fa follows from tip_chamfer_um or tip_rounding_um", ISO),
    Term("root_form_diameter d_ff dff true_involute_form_diameter tif tif_diameter", (),
         "d_Ff follows from the tool: dedendum_coefficient, rack_tip_radius_mm, protuberance_um", ISO),
    Term("start_of_active_profile sap sap_diameter d_nf dnf end_of_active_profile eap eap_diameter d_na "
         "dna", (),
         "the active profile follows from the tips and the centre distance; `evolvent check` has it", ISO),
    Term("tip_alteration tip_alteration_coefficient tip_shortening addendum_shortening truncation", (),
         "k follows from centre distance and profile shifts; tip_diameter_mm gives another tip", ISO),
    Term("j_bn jbn j_bt jbt j_t jt j_wt jwt normal_backlash circumferential_backlash", (),
         "backlash follows from pair.centre_distance_mm, the profile shifts and tooth_thickness_allowance_um; "
         "vibration takes it as dynamics.backlash_um", ISO),
    Term("sum_x sumx x_sum sum_of_profile_shifts profile_shift_sum", (),
         "the sum of the profile shifts follows from pinion.profile_shift and wheel.profile_shift", ISO),
    # what is not supported
    Term("ra_um r_a_um rz rz_um r_z r_z_um rq rq_um", (), "roughness is not supported: flanks are smooth", "ISO 4287"),
    Term("axial_offset axial_shift axial_position axial_displacement face_offset face_width_offset z_offset "
         "pair.offset "
         "gear.offset pair.position gear.position", (),
         "an axial offset of the gears is not supported: the middles of both faces meet"),
    Term("shaft_angle axis_angle", (), "crossed axes are not supported; tilts of the shafts in the plane of action are "
         "pair.misalignment_um"),
)
