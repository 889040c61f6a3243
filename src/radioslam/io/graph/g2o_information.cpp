#include "radioslam/io/graph/g2o_information.hpp"

#include "radioslam/io/graph/field_matrices.hpp"
#include "radioslam/io/graph/information.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {

template <int N>
Eigen::Matrix<double, N, N> G2oInformationReader::read(const TextLines& lines, LineFields& fields) {
  Eigen::Matrix<double, N, N> information = read_upper_triangle<N>(fields, "information");
  ++count_;
  if (information.isZero(0) && repair_ == RepairInformation::kNo)
    lines.fail("the information matrix is zero; --repair-information accepts such edges without effect");
  if (!information.isZero(0) && is_information(information)) return information;
  if (repair_ == RepairInformation::kYes) {
    ++repaired_;
    return nearest_information(information);
  }
  if (indefinite_++ == 0) {
    first_indefinite_line_ = lines.number();
    first_eigenvalue_ = relative_smallest_eigenvalue(information);
  }
  return information;
}

void G2oInformationReader::refuse_indefinite(const Text& text) const {
  if (indefinite_ == 0) return;
  text.fail(first_indefinite_line_, "the information matrix is indefinite (its smallest eigenvalue is " +
                                        format_number(first_eigenvalue_) +
                                        " of the largest), the first such of " + std::to_string(indefinite_) +
                                        " among " + std::to_string(count_) +
                                        "; --repair-information uses the nearest positive definite ones");
}

template Eigen::Matrix<double, 2, 2> G2oInformationReader::read(const TextLines&, LineFields&);
template Eigen::Matrix<double, 3, 3> G2oInformationReader::read(const TextLines&, LineFields&);
template Eigen::Matrix<double, 6, 6> G2oInformationReader::read(const TextLines&, LineFields&);

}  // namespace radioslam
