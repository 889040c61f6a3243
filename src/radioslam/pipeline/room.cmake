radioslam_room(pipeline SOURCES joint_graph.cpp robust_solution.cpp collect_results.cpp pipeline.cpp ROOMS closure results)
