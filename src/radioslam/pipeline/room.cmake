radioslam_room(pipeline SOURCES joint_graph.cpp robot_nodes.cpp radio_factors.cpp team_placement.cpp robust_solution.cpp collect_results.cpp pipeline.cpp ROOMS closure results)
