// One-way channel as the square root of the two-way product.
//
// By reciprocity the product is h^2 (docs/decisions): under multipath it contains the product of every
// pair of paths, while its square root contains the paths only, up to a sign per exchange and subcarrier. As
// the channel changes little between neighbours, their relative signs are known; they are propagated along a
// maximum spanning tree of |Re(h_a conj h_b)| over the grid of exchanges and subcarriers. A deep fade may
// flip the sign of what is behind it, unless the tree leads around the fade. Cost: N log N for N exchanges x
// subcarriers.
#pragma once

#include <Eigen/Core>

namespace radioslam {

/// h with h^2 = product, up to one global sign.
Eigen::MatrixXcd square_root_channel(const Eigen::MatrixXcd& product);

}  // namespace radioslam
