# A robot as a node of ROS 2: what it reads and publishes there.
radioslam_room(ros_node
  SOURCES
    heard_names.cpp
    robot_samples.cpp
    robot_topics.cpp
    ros_clock.cpp
    ros_publisher.cpp
    ros_subscriptions.cpp
    sample_reader.cpp
    sensor_frames.cpp
    stamp_gate.cpp
  ROOMS io io_dds front_end)
