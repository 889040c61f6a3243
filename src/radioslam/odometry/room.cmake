radioslam_room(odometry
  SOURCES
    imu_motion_prior.cpp
    map_drift.cpp
    motion_distortion.cpp
    scan_stage.cpp
    scan_tracking.cpp
    scans_on_odometry.cpp
  ROOMS lidar places inertial mission)
