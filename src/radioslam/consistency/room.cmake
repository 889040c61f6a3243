radioslam_room(consistency
  SOURCES
    chi_squared.cpp
    consistent_set.cpp
    maximum_clique.cpp
    pairwise.cpp
    undirected_graph.cpp
  ROOMS geometry)
