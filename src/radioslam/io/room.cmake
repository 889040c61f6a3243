radioslam_room(io SOURCES text.cpp numbers.cpp fields_of_line.cpp csv.cpp information.cpp g2o_read.cpp g2o_vertices.cpp g2o_write.cpp
                          tum.cpp kitti_poses.cpp mac_address.cpp csi_band.cpp pcap.cpp intel5300.cpp intel5300_write.cpp
                          nexmon_record.cpp nexmon_csi.cpp esp32_line.cpp esp32_training.cpp esp32_csi.cpp csi_capture.cpp
                          csi_folder.cpp wsr_trial.cpp wsr_results.cpp csi_yaml.cpp wifi_csv.cpp phone_log.cpp iw_ftm.cpp indoor_location.cpp yaml_map.cpp mission_yaml.cpp
                          mission_yaml_write.cpp team_tables.cpp team_tables_write.cpp anchor_tables.cpp usable_id.cpp robot_tables.cpp truth_labels.cpp lzf.cpp point_table.cpp point_times.cpp pcd_header.cpp pcd.cpp lidar_folder.cpp mission_folder.cpp atomic_output.cpp
                          zstd_text.cpp gzip.cpp bzip2.cpp packed_text.cpp carmen.cpp kitti_sequence.cpp
                          mapped_file.cpp lz4.cpp mcap.cpp ros1_bag.cpp ros_database.cpp ros_recording.cpp ros_message.cpp ros_types.cpp
                          frame_tree.cpp fixed_transforms.cpp moving_transforms.cpp ros_survey.cpp ros_topics.cpp ros_scans.cpp ros_body.cpp ros_collector.cpp ros_import.cpp pyfg.cpp g2o_team.cpp team_assembly.cpp team_graph_file.cpp
                          run_tables.cpp metrics_json.cpp run_folder_write.cpp run_folder_read.cpp
                          wifi_log.cpp printed_time.cpp printed_scans.cpp iw_scan.cpp iwlist_scan.cpp nmcli_list.cpp airodump_csv.cpp
                          radiotap.cpp wifi_capture.cpp quoted_row.cpp csv_files.cpp wifine.cpp wifi_rtt.cpp
               ROOMS graph mission radio results eval
               LIBRARIES nlohmann_json::nlohmann_json
               PRIVATE_LIBRARIES yaml-cpp Zstd::Zstd BZip2::BZip2 ZLIB::ZLIB Lz4::Lz4 SQLite::SQLite3 Pcap::Pcap)
