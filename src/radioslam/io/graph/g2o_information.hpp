// Reads the information matrices of a g2o file, and repairs or refuses those that are zero or indefinite.
// Indefinite ones are counted first and refused together, because a file has either none or many.
#pragma once

#include <cstddef>

#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {

class G2oInformationReader {
 public:
  explicit G2oInformationReader(RepairInformation repair) : repair_(repair) {}

  /// Reads the upper triangle at the end of a line. Refuses a zero matrix unless it is to be repaired.
  template <int N>
  Eigen::Matrix<double, N, N> read(const TextLines& lines, LineFields& fields);

  /// Refuses the file if any matrix was indefinite and not repaired.
  void refuse_indefinite(const Text& text) const;

  std::size_t repaired() const { return repaired_; }

 private:
  RepairInformation repair_;
  std::size_t repaired_ = 0;
  std::size_t count_ = 0;
  std::size_t indefinite_ = 0;
  std::size_t first_indefinite_line_ = 0;
  double first_eigenvalue_ = 0;
};

}  // namespace radioslam
