#include "radioslam/radio/channel/square_root_channel.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numeric>
#include <vector>

namespace radioslam {
namespace {

struct Link {
  float agreement;  ///< Re(h_a conj h_b)
  std::uint32_t a, b;
};

/// Disjoint sets of cells, each cell with its sign relative to the root of its set.
class SignedSets {
 public:
  explicit SignedSets(std::size_t count) : parent_(count), sign_(count, 1) {
    std::iota(parent_.begin(), parent_.end(), std::uint32_t{0});
  }

  /// Root of the cell's set, and the cell's sign relative to it.
  std::pair<std::uint32_t, signed char> find(std::uint32_t cell) {
    std::uint32_t root = cell;
    signed char sign = 1;
    for (; parent_[root] != root; root = parent_[root]) sign = static_cast<signed char>(sign * sign_[root]);
    const signed char whole = sign;
    while (parent_[cell] != root && cell != root) {
      const std::uint32_t next = parent_[cell];
      const auto rest = static_cast<signed char>(sign * sign_[cell]);
      parent_[cell] = root;
      sign_[cell] = sign;
      sign = rest;
      cell = next;
    }
    return {root, whole};
  }

  void join(const Link& link) {
    const auto [root_a, sign_a] = find(link.a);
    const auto [root_b, sign_b] = find(link.b);
    if (root_a == root_b) return;
    parent_[root_b] = root_a;
    sign_[root_b] = static_cast<signed char>((link.agreement >= 0 ? 1 : -1) * sign_a * sign_b);
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<signed char> sign_;  ///< relative to the parent
};

}  // namespace

Eigen::MatrixXcd square_root_channel(const Eigen::MatrixXcd& product) {
  Eigen::MatrixXcd h = product.cwiseSqrt();
  std::vector<Link> links;
  const auto cell = [&](Eigen::Index k, Eigen::Index s) {
    return static_cast<std::uint32_t>(k * h.cols() + s);
  };
  const auto link = [&](Eigen::Index k, Eigen::Index s, Eigen::Index later, Eigen::Index above) {
    if (k + later >= h.rows() || s + above >= h.cols()) return;
    links.push_back({static_cast<float>((h(k, s) * std::conj(h(k + later, s + above))).real()), cell(k, s),
                     cell(k + later, s + above)});
  };
  for (Eigen::Index k = 0; k < h.rows(); ++k)
    for (Eigen::Index s = 0; s < h.cols(); ++s) {
      link(k, s, 1, 0);
      link(k, s, 2, 0);
      link(k, s, 0, 1);
    }
  std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) {
    return std::abs(a.agreement) > std::abs(b.agreement);
  });
  SignedSets sets(static_cast<std::size_t>(h.size()));
  for (const Link& one : links) sets.join(one);
  for (Eigen::Index k = 0; k < h.rows(); ++k)
    for (Eigen::Index s = 0; s < h.cols(); ++s) h(k, s) *= sets.find(cell(k, s)).second;
  return h;
}

}  // namespace radioslam
