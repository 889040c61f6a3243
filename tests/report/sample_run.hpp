// Synthetic runs to draw: loops around a hall, odometry that drifts, an estimate that hardly does.
#pragma once

#include <optional>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam::sample {

struct SampleParams {
  int robots = 3;
  int keyframes = 600;
  int closures = 800;
  int candidates = 0;
  int alternatives = 0;
  int dimension = 2;
  int aoa_measurements = 0;
};

struct Sample {
  RunResult result;
  Truth truth;
  TeamMetrics metrics;
};

/// The same parameters give the same run.
Sample make_sample(const SampleParams& params = {});

}  // namespace radioslam::sample
