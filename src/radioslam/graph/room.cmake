radioslam_room(graph SOURCES loss.cpp pose_chart.cpp residuals.cpp linearisation.cpp gauge.cpp
               block_structure.cpp normal_equations.cpp optimizer.cpp
               relative_pose_network.cpp spanning_tree.cpp pose_network_solver.cpp chordal.cpp
               initial_values.cpp marginals.cpp graduated.cpp
               linear/block_matrix.cpp linear/ordering.cpp linear/elimination_tree.cpp
               linear/supernodes.cpp linear/front_tree.cpp linear/front_kernels.cpp
               linear/front_kernels_two.cpp linear/front_kernels_four.cpp linear/block_cholesky.cpp
               linear/selected_inverse.cpp linear/number_store.cpp linear/front_solve.cpp ROOMS geometry PRIVATE_LIBRARIES Metis::Metis Amd::Amd)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set_source_files_properties(graph/linear/front_kernels_four.cpp PROPERTIES COMPILE_OPTIONS -mavx2)
endif()
# The kernels are one source each on purpose: each defines the same functions for other registers.
set_source_files_properties(graph/linear/front_kernels.cpp graph/linear/front_kernels_two.cpp
                            graph/linear/front_kernels_four.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
