radioslam_room(inertial SOURCES inertial_state.cpp reading_intervals.cpp preintegration.cpp motion_prediction.cpp inertial_factor.cpp gravity_alignment.cpp state_chain.cpp state_factors.cpp inertial_filter.cpp
               inertial_smoother.cpp odometry_noise_of_states.cpp reading_agreement.cpp wild_readings.cpp ROOMS mission)
