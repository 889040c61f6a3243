radioslam_room(inertial
  SOURCES
    gravity_alignment.cpp
    imu_consistency.cpp
    imu_intervals.cpp
    imu_outliers.cpp
    inertial_filter.cpp
    inertial_smoother.cpp
    inertial_state.cpp
    motion_prediction.cpp
    odometry_noise_inflation.cpp
    preintegration.cpp
    state_factors.cpp
  ROOMS mission)
