# The command line programs. Their code is a library so that tests can link it; that library is not installed.
set(cli_include ${PROJECT_BINARY_DIR}/rooms/cli)
file(MAKE_DIRECTORY ${cli_include}/radioslam)
file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/cli ${cli_include}/radioslam/cli SYMBOLIC)

add_library(radioslam_cli STATIC
  cli/commands/aoa_output.cpp
  cli/commands/command_anchors.cpp
  cli/commands/command_aoa.cpp
  cli/commands/command_doctor.cpp
  cli/commands/command_evaluate.cpp
  cli/commands/command_import.cpp
  cli/commands/command_log.cpp
  cli/commands/command_map.cpp
  cli/commands/command_optimize.cpp
  cli/commands/command_options.cpp
  cli/commands/command_parameters.cpp
  cli/commands/command_poses.cpp
  cli/commands/command_prune.cpp
  cli/commands/command_rendezvous.cpp
  cli/commands/command_run.cpp
  cli/commands/command_similarity.cpp
  cli/commands/command_simulate.cpp
  cli/team/command_team.cpp
  cli/team/network_options.cpp
  cli/team/process_team.cpp
  cli/team/team_output.cpp
  cli/commands/csi_channels.cpp
  cli/commands/distributed_optimization.cpp
  cli/commands/evaluated_estimate.cpp
  cli/commands/evaluation.cpp
  cli/commands/map_output.cpp
  cli/commands/mission_check.cpp
  cli/commands/mission_input.cpp
  cli/commands/other_programs.cpp
  cli/commands/output_path_check.cpp
  cli/run_documents.cpp
  cli/recorded_drive.cpp
  cli/config.cpp
  cli/online_output.cpp
  cli/ending.cpp
  cli/freed_memory.cpp
  cli/import/import_android.cpp
  cli/import/import_datasets.cpp
  cli/import/import_kinds.cpp
  cli/import/import_lidar.cpp
  cli/import/import_options.cpp
  cli/import/import_ranges.cpp
  cli/import/import_walk.cpp
  cli/import/import_wifi.cpp
  cli/import/ros_sources.cpp
  cli/import/wifi_summary.cpp
  cli/parameter_sets.cpp
  cli/parameters.cpp
  cli/program.cpp
  cli/progress_line.cpp
  cli/run_parameters.cpp)
add_library(radioslam::cli ALIAS radioslam_cli)
target_include_directories(radioslam_cli PUBLIC ${cli_include})
target_link_libraries(radioslam_cli
  PUBLIC radioslam_results radioslam_io CLI11::CLI11
  PRIVATE radioslam_doctor radioslam_rendezvous_world radioslam_front_end radioslam_live radioslam_team radioslam_pipeline radioslam_eval radioslam_report yaml-cpp nlohmann_json::nlohmann_json radioslam_warnings)
target_compile_definitions(radioslam_cli PRIVATE RADIOSLAM_VERSION="${PROJECT_VERSION}")
radioslam_group_sources(radioslam_cli)
radioslam_precompile(radioslam_cli ${PROJECT_SOURCE_DIR}/cmake/precompiled.hpp)
# Nothing is computed here, and a quarter of the compiler's time is spent above -O1.
target_compile_options(radioslam_cli PRIVATE $<$<CONFIG:Release>:-O1>)

add_executable(radioslam_program cli/main.cpp)
target_link_libraries(radioslam_program PRIVATE radioslam_cli radioslam_warnings)
set_target_properties(radioslam_program PROPERTIES
  OUTPUT_NAME radioslam RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})

# `radioslam reproduce` starts it. Tables and studies are a program of their own because they take a fifth of the build.
add_executable(radioslam_reproduce cli/reproduce/main.cpp cli/reproduce/command_reproduce.cpp)
target_link_libraries(radioslam_reproduce PRIVATE radioslam_cli radioslam_study radioslam_warnings)
set_target_properties(radioslam_reproduce PROPERTIES
  OUTPUT_NAME radioslam-reproduce RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})

# `radioslam agent` starts it. Apart, so that only programs that join a domain load Cyclone's library.
add_library(radioslam_agent_process STATIC
  cli/agent/agent_process.cpp
  cli/agent/agent_publisher.cpp
  cli/agent/command_agent.cpp
  cli/agent/agent_view.cpp
  cli/agent/inbox.cpp
  cli/agent/live_page.cpp
  cli/agent/live_view.cpp
  cli/agent/outbox.cpp
  cli/agent/front_end_thread.cpp
  cli/agent/recorded_source.cpp
  cli/agent/ros_options.cpp
  cli/agent/ros_source.cpp
  cli/agent/worker.cpp)
target_link_libraries(radioslam_agent_process PUBLIC radioslam_cli radioslam_ros_node radioslam_io_live radioslam_report_live radioslam_team radioslam_pipeline PRIVATE radioslam_warnings)
add_executable(radioslam_agent cli/agent/main.cpp)
target_link_libraries(radioslam_agent PRIVATE radioslam_agent_process radioslam_warnings)
set_target_properties(radioslam_agent PROPERTIES
  OUTPUT_NAME radioslam-agent RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
