// A sum of matrices whose error does not grow with the number of terms (Neumaier 1974): what an addition
// rounds away is kept and added at the end.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace radioslam {

template <class Matrix>
class CompensatedSum {
 public:
  void add(const Matrix& term) {
    const Matrix next = sum_ + term;
    for (Eigen::Index i = 0; i < term.size(); ++i) {
      const double s = sum_.data()[i], t = term.data()[i], n = next.data()[i];
      lost_.data()[i] += std::abs(s) >= std::abs(t) ? (s - n) + t : (t - n) + s;
    }
    sum_ = next;
  }
  Matrix value() const { return sum_ + lost_; }

 private:
  Matrix sum_ = Matrix::Zero(), lost_ = Matrix::Zero();
};

}  // namespace radioslam
