radioslam_room(radio
  SOURCES
    aoa/aoa_array.cpp
    aoa/aoa_estimate.cpp
    aoa/aoa_likelihood.cpp
    aoa/aoa_peaks.cpp
    aoa/aoa_track.cpp
    aoa/beam_kernel_avx2.cpp
    aoa/beam_kernel_sse2.cpp
    aoa/beam_objective.cpp
    aoa/beamforming.cpp
    aoa/delay_alignment.cpp
    aoa/multipath_model.cpp
    aoa/steering_sums.cpp
    captures/clock_offset.cpp
    captures/csi_aoa.cpp
    captures/csi_stage.cpp
    captures/csi_tracks.cpp
    channel/capture_power.cpp
    channel/two_way_channel.cpp
    fingerprints/access_point_fixes.cpp
    fingerprints/access_points.cpp
    fingerprints/censored_loss.cpp
    fingerprints/distance_model.cpp
    fingerprints/fingerprint.cpp
    fingerprints/fingerprint_blocks.cpp
    fingerprints/fingerprint_comparison.cpp
    fingerprints/measurements.cpp
    fingerprints/path_loss_objective.cpp
    fingerprints/rssi_offset.cpp
    fingerprints/similarity.cpp
    fingerprints/similarity_join.cpp
    fingerprints/similarity_kernel_avx2.cpp
    fingerprints/similarity_kernel_sse2.cpp
    fingerprints/similarity_lanes.cpp
    fingerprints/similarity_sums.cpp
    fingerprints/team_similarity.cpp
    ranging/anchor_distances.cpp
    ranging/anchor_layout.cpp
    ranging/multilateration.cpp
    ranging/range_bias.cpp
    ranging/range_epochs.cpp
  ROOMS consistency mission results)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set_source_files_properties(radio/aoa/beam_kernel_avx2.cpp radio/fingerprints/similarity_kernel_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2;-fno-math-errno" SKIP_PRECOMPILE_HEADERS ON)
endif()
# These kernels use vectors wider than the registers, but never pass them across files.
set_source_files_properties(radio/aoa/beam_kernel_sse2.cpp radio/fingerprints/similarity_kernel_sse2.cpp PROPERTIES COMPILE_OPTIONS "-Wno-psabi;-fno-math-errno" SKIP_PRECOMPILE_HEADERS ON)
# Excluded from unity builds: each file defines the same functions for another instruction set.
set_source_files_properties(radio/aoa/beam_kernel_sse2.cpp radio/aoa/beam_kernel_avx2.cpp
                            radio/fingerprints/similarity_kernel_sse2.cpp radio/fingerprints/similarity_kernel_avx2.cpp
                            PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
