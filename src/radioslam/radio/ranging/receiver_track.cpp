#include "radioslam/radio/ranging/receiver_track.hpp"

#include <cmath>

namespace radioslam {
namespace {

PositionFix fix_of(const RangeEpoch& epoch, const Multilateration& found) {
  PositionFix fix{epoch.stamp, Eigen::Vector3d::Zero(), found.sigma_m};
  fix.position_m.head(found.position_m.size()) = found.position_m;
  return fix;
}

double rms_of(const std::vector<std::optional<Multilateration>>& epochs) {
  double sum = 0, count = 0;
  for (const auto& epoch : epochs) {
    if (!epoch) continue;
    for (const double residual : epoch->residuals_m) sum += residual * residual, ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace

ReceiverTrack track_receiver(const Eigen::MatrixXd& anchors_m, const std::vector<AnchorRange>& ranges,
                             std::size_t pairs, const ReceiverTrackParams& params) {
  const auto epochs = range_epochs(ranges, params.epochs);
  const auto found = calibrate_positions(anchors_m, epochs, pairs, params.position, params.bias);
  std::vector<PositionFix> fixes;
  for (std::size_t k = 0; k < epochs.size(); ++k) {
    if (!found.epochs[k]) continue;
    const bool same_time = !fixes.empty() && fixes.back().stamp >= epochs[k].stamp;
    if (!same_time) fixes.push_back(fix_of(epochs[k], *found.epochs[k]));
  }
  return {moving_median(fixes, params.epochs), found.biases, epochs.size(), found.noise_factor,
          rms_of(found.epochs)};
}

}  // namespace radioslam
