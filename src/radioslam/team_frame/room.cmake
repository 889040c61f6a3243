radioslam_room(team_frame SOURCES multidimensional_scaling.cpp rigid_layout.cpp fingerprint_layout.cpp ROOMS radio)
