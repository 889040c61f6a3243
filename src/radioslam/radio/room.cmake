radioslam_room(radio SOURCES fingerprint.cpp similarity.cpp distance_model.cpp decay_model.cpp measurements.cpp
               anchor_distances.cpp anchor_frame.cpp anchor_layout.cpp multilateration.cpp range_epochs.cpp range_bias.cpp receiver_track.cpp
                       two_way_channel.cpp arrival_likelihood.cpp effective_snr.cpp intel5300_power.cpp ROOMS mission)
