// From the product of the channels both ways to the channel of one way.
//
// The product is h^2 (the air is reciprocal; docs/decisions.md), and of many paths it holds every pair's
// product. Its square root has the paths alone, but for a sign at each exchange and subcarrier. The channel
// changes little from one to the next, so neighbours' signs follow from each other, the surest first: along
// a maximum spanning tree of |Re(h_a conj h_b)| over the grid of exchanges and subcarriers. Where the channel
// fades out a sign may be lost, and with it the sign of what lies beyond, unless a way around is surer.
// Cost: N log N for N exchanges x subcarriers.
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// h with h^2 = product, up to one sign for the whole.
Eigen::MatrixXcd square_root_channel(const Eigen::MatrixXcd& product);

}  // namespace radioslam
