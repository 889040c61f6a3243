// Distributed overlap search between two robots that each hold their own poses only. Both know the alignment
// (the links, or the skeleton's covariances between the two) and each other's sensor. Robot a is the client,
// b the server:
//
//   a -> b   which of b's boxes to open, and of which to send the poses
//   b -> a   the pose records of each box of the second list, the summaries of both halves of each opened box
//   ...      a box is opened only if it may overlap a box of a's; until there is nothing left to request
//   a -> b   the pairs kept
//
// a never sends its own poses, and every box and pose of b is sent at most once. a runs the same tests on the
// same numbers as the central search, so results are identical to the last bit. Encoding: little endian;
// counts, pose and node indices as uint32, everything else as IEEE doubles, of symmetric matrices the lower
// triangle. A malformed message throws std::invalid_argument.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "radioslam/base/wire.hpp"
#include "radioslam/closure/overlap/overlap_bounds.hpp"

namespace radioslam {

using OverlapMessage = std::string;

/// Throws std::invalid_argument unless the condition holds.
inline void expect_well_formed(bool condition) {
  if (!condition) throw std::invalid_argument("malformed message of an overlap exchange");
}

// One list of fields serves writing and reading.

class OverlapFieldWriter {
 public:
  void operator()(std::uint32_t value) { out_.u32(value); }
  void operator()(double value) { out_.f64(value); }
  template <int Rows, int Columns>
  void operator()(const Eigen::Matrix<double, Rows, Columns>& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) out_.f64(m.data()[i]);
  }
  template <int N>
  void symmetric(const Eigen::Matrix<double, N, N>& m) {
    for (int j = 0; j < N; ++j)
      for (int i = j; i < N; ++i) out_.f64(m(i, j));
  }
  OverlapMessage take() { return out_.take(); }

 private:
  WireWriter out_;
};

class OverlapFieldReader {
 public:
  explicit OverlapFieldReader(const OverlapMessage& bytes) : in_(bytes) {}

  void operator()(std::uint32_t& value) { value = number(); }
  void operator()(double& value) {
    value = in_.f64();
    expect_well_formed(in_.good());
  }
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
  std::uint32_t number() {
    const std::uint32_t value = in_.u32();
    expect_well_formed(in_.good());
    return value;
  }
  bool at_end() const { return in_.empty(); }

 private:
  WireReader in_;
};

/// All fields of a box's summary except the record of its middle pose.
template <class Node, class Visitor>
void visit_node(Node& node, Visitor&& visit) {
  visit(node.begin), visit(node.end), visit(node.middle), visit(node.right);
  visit(node.centre_m), visit(node.half_extent_m), visit(node.radius_m);
  visit(node.spread.sigma_m), visit(node.spread.sigma_rad), visit(node.heading_spread_rad);
  visit(node.min_travelled_m), visit(node.max_travelled_m);
}

/// Side of robot b.
template <OverlapSource Source>
class OverlapServer {
 public:
  using Pose = typename Source::View::Pose;

  OverlapServer(const Source& source, std::size_t robot)
      : records_(source.records(robot)), tree_(OverlapTreeBuilder<Source>(source, robot).build()) {}

  /// Summaries of the tree's roots.
  OverlapMessage hello() const;
  OverlapMessage answer(const OverlapMessage& request) const;
  /// All poses in one message, for comparison of its size.
  OverlapMessage everything() const;

 private:
  const std::vector<typename Source::View::Record>& records_;
  OverlapTree<Pose> tree_;
};

/// Side of robot a.
template <OverlapSource Source>
class OverlapClient {
 public:
  using View = typename Source::View;
  using Pose = typename View::Pose;
  using Record = typename View::Record;

  /// Reads only robot a's poses, the view and which trajectory segments are connected from `source`.
  OverlapClient(const Source& source, std::uint32_t a, std::uint32_t b, const OverlapRule& rule);

  void receive_hello(const OverlapMessage& hello);
  /// Empty if there is nothing left to request.
  OverlapMessage request();
  void receive_answer(const OverlapMessage& answer);

  /// Pairs kept, ordered by poses.
  OverlapCandidates result() const;
  /// The same, as the message to b.
  OverlapMessage final_message() const;

 private:
  using Test = OverlapTest<View>;
  using Bound = LinkBound<Pose>;
  using Node = OverlapNode<Pose>;
  struct Summary {
    Node node;
    Record middle;
  };
  /// A box of a that waits for data of a box of b.
  struct Waiting {
    std::uint32_t node_a;
    std::vector<Bound> ties;
  };

  const Summary& read_summary(std::uint32_t j, std::uint32_t begin, OverlapFieldReader& in);
  void visit_boxes(std::uint32_t i, std::uint32_t j, std::span<const Bound> from);
  bool knows_poses(const Node& J) const;
  void compare(const Waiting& box, const Node& J);

  const Source& source_;
  std::uint32_t a_, b_;
  View view_;
  Test test_;
  OverlapTree<Pose> tree_;
  std::map<std::uint32_t, Summary> summaries_;  ///< of b's nodes
  std::map<std::uint32_t, Record> poses_;       ///< of b, as received
  std::map<std::uint32_t, std::vector<Waiting>> to_open_, to_send_, asked_open_, asked_send_;
  OverlapCandidates found_;
};

/// Traffic of an exchange, in bytes.
struct ExchangeCost {
  std::uint64_t requests = 0, answers = 0, final_message = 0;
  std::uint64_t all_poses = 0;  ///< if all poses were sent instead of requests and answers
  int rounds = 0;
};

struct OverlapExchange {
  OverlapCandidates found;
  ExchangeCost cost;
};

/// Runs both sides for robots a < b; finds what search_overlaps finds between them, and the traffic.
template <OverlapSource Source>
OverlapExchange exchange_overlaps(const Source& source, std::uint32_t a, std::uint32_t b,
                                  const std::vector<OverlapSensor>& sensors, const OverlapParams& params);

}  // namespace radioslam
