radioslam_room(consistency SOURCES chi_squared.cpp undirected_graph.cpp degeneracy.cpp greedy_clique.cpp
               maximum_clique.cpp pairwise.cpp consistent_set.cpp ROOMS geometry)
