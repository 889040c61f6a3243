// The page, from top to bottom.

write_headline();
write_map();
write_errors();
write_agents();
write_stream();
write_robots();
write_frames();
write_hypotheses();
write_overlap();
write_places();
write_directions();
write_access_points();
write_signals();
write_similarity();
write_closures();
write_compared_closures();
write_range_biases();
write_angle_checks();
write_timings();
write_counts();
write_parameters();
