radioslam_room(sim SOURCES lane_grid.cpp drive.cpp wheel_odometry.cpp shadowing.cpp transmitters.cpp phones.cpp
                           carpark.cpp stamps.cpp hills.cpp surface_odometry.cpp street_grid.cpp team_drives.cpp
                           image_sources.cpp csi_channel.cpp csi_card.cpp csi_exchange.cpp turn_drives.cpp csi_room.cpp
                           arrival_paths.cpp radio_channel.cpp aliased_matches.cpp radio_mission.cpp city.cpp
                           hall.cpp corridors.cpp town_houses.cpp upright_shapes.cpp floor_grid.cpp ray_world.cpp
                           spline_motion.cpp true_motion.cpp smooth_ride.cpp inertial_unit.cpp lidar_scanner.cpp
                           onboard_sensors.cpp gnss_receiver.cpp kitti.cpp scenarios.cpp ROOMS base geometry mission)
