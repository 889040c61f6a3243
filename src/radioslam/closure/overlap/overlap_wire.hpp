// Serialisation of overlap exchange messages (overlap_exchange.hpp): one list of fields serves writing and
// reading.
#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace radioslam {

/// Writes little endian on any machine.
class WireWriter {
 public:
  void operator()(std::uint32_t value) { put(value); }
  void operator()(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  template <int Rows, int Columns>
  void operator()(const Eigen::Matrix<double, Rows, Columns>& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) (*this)(m.data()[i]);
  }
  template <int N>
  void symmetric(const Eigen::Matrix<double, N, N>& m) {
    for (int j = 0; j < N; ++j)
      for (int i = j; i < N; ++i) (*this)(m(i, j));
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  void put(auto value) {
    for (std::size_t i = 0; i < sizeof(value); ++i)
      bytes_.push_back(static_cast<std::byte>((value >> (8 * i)) & 0xFF));
  }
  std::vector<std::byte> bytes_;
};

class WireReader {
 public:
  explicit WireReader(const std::vector<std::byte>& bytes) : bytes_(bytes) {}

  void operator()(std::uint32_t& value) { value = get<std::uint32_t>(); }
  void operator()(double& value) { value = std::bit_cast<double>(get<std::uint64_t>()); }
  template <int Rows, int Columns>
  void operator()(Eigen::Matrix<double, Rows, Columns>& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) (*this)(m.data()[i]);
  }
  template <int N>
  void symmetric(Eigen::Matrix<double, N, N>& m) {
    for (int j = 0; j < N; ++j)
      for (int i = j; i < N; ++i) {
        (*this)(m(i, j));
        m(j, i) = m(i, j);
      }
  }
  std::uint32_t number() { return get<std::uint32_t>(); }
  bool at_end() const { return at_ == bytes_.size(); }
  /// Throws std::invalid_argument unless the condition holds.
  static void expect(bool condition) {
    if (!condition) throw std::invalid_argument("malformed message of an overlap exchange");
  }

 private:
  template <class Value>
  Value get() {
    expect(bytes_.size() - at_ >= sizeof(Value));
    Value value = 0;
    for (std::size_t i = 0; i < sizeof(Value); ++i)
      value |=
          static_cast<Value>(static_cast<Value>(std::to_integer<std::uint8_t>(bytes_[at_ + i])) << (8 * i));
    at_ += sizeof(Value);
    return value;
  }
  const std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

/// All fields of a box's summary except the record of its middle pose.
template <class Node, class Visitor>
void visit_node(Node& node, Visitor&& visit) {
  visit(node.begin), visit(node.end), visit(node.middle), visit(node.right);
  visit(node.centre_m), visit(node.half_extent_m), visit(node.radius_m);
  visit(node.spread.sigma_m), visit(node.spread.sigma_rad), visit(node.heading_spread_rad);
  visit(node.min_travelled_m), visit(node.max_travelled_m);
}

}  // namespace radioslam
