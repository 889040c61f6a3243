radioslam_room(odometry
  SOURCES
    imu_motion_prior.cpp
    inertial_odometry.cpp
    map_drift.cpp
    motion_distortion.cpp
    motion_prior.cpp
    odometry_from_scans.cpp
    scan_stage.cpp
    scan_tracking.cpp
    scan_tracking_with_imu.cpp
  ROOMS lidar inertial mission)
