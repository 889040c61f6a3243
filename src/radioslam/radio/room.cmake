radioslam_room(radio SOURCES fingerprint.cpp similarity.cpp similarity_sums.cpp similarity_need.cpp similarity_lanes.cpp
                       similarity_kernel_narrow.cpp similarity_kernel_wide.cpp place_order.cpp fingerprint_blocks.cpp joined_rows.cpp similarity_join.cpp fingerprint_comparison.cpp team_similarity.cpp
               distance_model.cpp decay_model.cpp device_offset.cpp measurements.cpp
               anchor_distances.cpp anchor_frame.cpp anchor_layout.cpp multilateration.cpp range_epochs.cpp range_bias.cpp receiver_track.cpp
                       two_way_channel.cpp arrival_likelihood.cpp effective_snr.cpp intel5300_power.cpp capture_power.cpp beam_sums.cpp beam_kernel_narrow.cpp beam_kernel_wide.cpp subcarrier_slopes.cpp
                       square_root_channel.cpp array_beams.cpp path_model.cpp arrival_track.cpp arrival_array.cpp arrival_slopes.cpp
                       arrival_channel.cpp beam_objective.cpp arrival_peaks.cpp clock_offset.cpp arrival_estimate.cpp path_loss.cpp access_points.cpp ROOMS consistency mission)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set_source_files_properties(radio/beam_kernel_wide.cpp radio/similarity_kernel_wide.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;-fno-math-errno")
endif()
# Their vectors are wider than the registers; none of them leaves its file.
set_source_files_properties(radio/beam_kernel_narrow.cpp radio/similarity_kernel_narrow.cpp PROPERTIES COMPILE_OPTIONS "-Wno-psabi;-fno-math-errno")
# One source each on purpose: each defines the same functions for other registers.
set_source_files_properties(radio/beam_kernel_narrow.cpp radio/beam_kernel_wide.cpp
                            radio/similarity_kernel_narrow.cpp radio/similarity_kernel_wide.cpp
                            PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
