// Bytes of a positive semidefinite matrix of blocks: its Cholesky factor with rows scaled to unit length, in
// three bytes an entry. Rounding the factor leaves weak directions what they are, where rounding the matrix
// itself would drown them in the strong ones (an entry's error is 1e-7 of the root of an eigenvalue instead
// of the largest eigenvalue), and what is read is semidefinite again.
// Blocks of zeros, which chains of odometry leave, take a bit each. Where the factor would have so many more
// blocks than the matrix that the matrix itself is shorter, it is sent instead, in double precision.
#pragma once

#include <Eigen/Core>

#include "radioslam/graph/distributed/wire.hpp"

namespace radioslam {

void write_information(WireWriter& out, const Eigen::MatrixXd& information, Eigen::Index block);
/// Of `blocks` blocks of `block` rows.
Eigen::MatrixXd read_information(WireReader& in, Eigen::Index blocks, Eigen::Index block);

}  // namespace radioslam
