radioslam_room(inertial
  SOURCES
    gravity_alignment.cpp
    imu_consistency.cpp
    imu_outliers.cpp
    imu_path.cpp
    inertial_filter.cpp
    inertial_smoother.cpp
    odometry_noise_inflation.cpp
    preintegration.cpp
    state_factors.cpp
  ROOMS mission)
