radioslam_room(team_frame SOURCES multidimensional_scaling.cpp rigid_layout.cpp fingerprint_bodies.cpp quasi_newton.cpp radio_field.cpp field_refinement.cpp strays.cpp fingerprint_layout.cpp fix_alignment.cpp compressed_team.cpp
                                  measurement_mixture.cpp mixture_refinement.cpp alignment_grid.cpp tied_team.cpp level_priors.cpp observed_information.cpp
                                  place_search.cpp fewer_links.cpp radio_alignment.cpp ROOMS radio graph)
