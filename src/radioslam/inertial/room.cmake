radioslam_room(inertial SOURCES inertial_state.cpp reading_intervals.cpp preintegration.cpp motion_prediction.cpp inertial_factor.cpp gravity_alignment.cpp ROOMS mission)
