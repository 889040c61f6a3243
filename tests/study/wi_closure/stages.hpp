// What holds for the runs of every study of place recognition.
#pragma once

#include <gtest/gtest.h>

#include "radioslam/study/wi_closure/place_study.hpp"

namespace radioslam {

inline void expect_stages_in_order(const PlaceStudy& study) {
  const PairCounts& pairs = study.search.candidates;
  EXPECT_GT(pairs.true_pairs, 0U);
  EXPECT_GE(pairs.pairs, pairs.kept);
  EXPECT_GE(pairs.kept, pairs.true_kept);
  EXPECT_GE(pairs.true_pairs, pairs.true_kept);
  for (const PlaceRuns& runs : study.runs) {
    for (const PlaceRun* run : {&runs.without_radio, &runs.unpruned, &runs.pruned}) {
      EXPECT_GT(run->places.pairs, 0U);
      EXPECT_GE(run->places.registrations, run->places.verified);
      EXPECT_GE(run->places.verified, run->closures.accepted);
      EXPECT_GE(run->closures.accepted, run->closures.true_accepted);
      EXPECT_EQ(run->in_one_frame, run->ate_m.has_value());
      EXPECT_GT(run->scans_s, 0);
      EXPECT_GT(run->places_s, 0);
      EXPECT_GE(run->rest_s(), 0);
    }
    EXPECT_TRUE(runs.unpruned.in_one_frame);
    EXPECT_TRUE(runs.pruned.in_one_frame);
  }
}

/// Of runs of one round.
inline void expect_no_pair_twice(const PlaceRuns& runs) {
  EXPECT_GE(runs.unpruned.places.pairs, runs.unpruned.places.allowed);
  EXPECT_GE(runs.unpruned.places.allowed, runs.pruned.places.allowed);
  EXPECT_GT(runs.pruned.places.allowed, 0U);
  EXPECT_GE(runs.unpruned.places.allowed, runs.unpruned.places.compared);
}

}  // namespace radioslam
