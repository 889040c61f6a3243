# The program. What the tests look into is a library of its own; it is not installed.
set(cli_include ${PROJECT_BINARY_DIR}/rooms/cli)
file(MAKE_DIRECTORY ${cli_include}/radioslam)
file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR}/cli ${cli_include}/radioslam/cli SYMBOLIC)

add_library(radioslam_cli STATIC
  cli/arrival_output.cpp
  cli/command_anchors.cpp
  cli/command_aoa.cpp
  cli/command_evaluate.cpp
  cli/command_import.cpp
  cli/command_optimize.cpp
  cli/command_options.cpp
  cli/command_parameters.cpp
  cli/command_prune.cpp
  cli/command_reproduce.cpp
  cli/command_run.cpp
  cli/command_similarity.cpp
  cli/command_simulate.cpp
  cli/config.cpp
  cli/heard_channels.cpp
  cli/import_lidar.cpp
  cli/import_options.cpp
  cli/import_wifi.cpp
  cli/judgement.cpp
  cli/mission_input.cpp
  cli/output_apart.cpp
  cli/pair_table.cpp
  cli/parameters.cpp
  cli/program.cpp
  cli/progress_line.cpp
  cli/recorded_drive.cpp
  cli/recorded_trials.cpp
  cli/suggestion.cpp
  cli/wifi_target.cpp)
add_library(radioslam::cli ALIAS radioslam_cli)
target_include_directories(radioslam_cli PUBLIC ${cli_include})
target_link_libraries(radioslam_cli
  PUBLIC radioslam_results radioslam_io CLI11::CLI11
  PRIVATE radioslam_pipeline radioslam_eval radioslam_sim radioslam_report radioslam_study yaml-cpp nlohmann_json::nlohmann_json radioslam_warnings)
target_compile_definitions(radioslam_cli PRIVATE RADIOSLAM_VERSION="${PROJECT_VERSION}")

add_executable(radioslam_program cli/main.cpp cli/signals.cpp)
target_link_libraries(radioslam_program PRIVATE radioslam_cli radioslam_io radioslam_warnings)
set_target_properties(radioslam_program PROPERTIES
  OUTPUT_NAME radioslam RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
