radioslam_room(graph
  SOURCES
    block_structure.cpp
    chordal.cpp
    distributed/alternating.cpp
    distributed/block_coordinate.cpp
    distributed/cluster.cpp
    distributed/frames.cpp
    distributed/held_factors.cpp
    distributed/information_code.cpp
    distributed/message.cpp
    distributed/outliers.cpp
    distributed/robot_graph.cpp
    distributed/separators.cpp
    distributed/simulated_network.cpp
    distributed/stage_agreement.cpp
    distributed/step_system.cpp
    distributed/team_optimization.cpp
    distributed/team_outcome.cpp
    distributed/topology.cpp
    distributed/turns.cpp
    distributed/two_stage.cpp
    gauge.cpp
    graduated.cpp
    initial_values.cpp
    linear/block_cholesky.cpp
    linear/block_matrix.cpp
    linear/front_elimination.cpp
    linear/front_kernels.cpp
    linear/front_kernels_avx2.cpp
    linear/front_kernels_sse2.cpp
    linear/front_solve.cpp
    linear/front_tree.cpp
    linear/number_store.cpp
    linear/partial_elimination.cpp
    linear/partitioned_inverse.cpp
    linear/selected_inverse.cpp
    linear/supernodes.cpp
    linearisation.cpp
    loss.cpp
    marginals.cpp
    normal_equations.cpp
    optimizer.cpp
    pose_chart.cpp
    pose_network.cpp
    residuals.cpp
    robust_optimum.cpp
    team_gauge.cpp
  ROOMS geometry
  PRIVATE_LIBRARIES Metis::Metis Amd::Amd)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set_source_files_properties(graph/linear/front_kernels_avx2.cpp PROPERTIES COMPILE_OPTIONS -mavx2 SKIP_PRECOMPILE_HEADERS ON)
endif()
# The kernels are one source each on purpose: each defines the same functions for other registers.
set_source_files_properties(graph/linear/front_kernels.cpp graph/linear/front_kernels_sse2.cpp
                            graph/linear/front_kernels_avx2.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
