// Exploring by turns: some robots stand still as landmarks, and those that explore come back to one of them
// before they are lost.
//
// A landmark does not drift. When robot i, with an expected squared error e_i of its own, meets one, all of
// e_i is gained for i's way back; if both had explored, or if the landmark had come to i, about half of it
// (expected_gain). A way that ends where it began is also known in between: L steps of heading noise have a
// mean square error of L^3 / 420 where it is closed and of L^3 / 12 where it is not. So the robot with the
// error returns, to the landmark that gains most per metre, and the one that has travelled least explores
// next.
//
// Robots agree on this by what each says of itself, again and again: whether it stands, and on whom it leans.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace radioslam {

/// What matters of a robot that is heard.
struct AnchorNeighbour {
  std::string robot;
  bool standing = false;
  std::string leans_on;
  double error = 0;
  double walked_m = 0;
  double distance_m = 0;
};

struct AnchoredParams {
  double delta = 10;           ///< error at which a robot comes back
  double anchor_range_m = 30;  ///< landmarks further away are not leant on
};

class AnchoredExploration {
 public:
  enum class Role { kExploring, kStanding, kReturning };

  /// A decision; `neighbours` are those that are still there and not shunned, by name.
  void decide(const std::string& self, double error, double walked_m,
              const std::vector<AnchorNeighbour>& neighbours, const AnchoredParams& params);
  /// The landmark was met often enough.
  void met(double walked_m, const std::vector<AnchorNeighbour>& neighbours);

  Role role() const { return role_; }
  const std::string& leans_on() const { return leans_on_; }
  bool waits() const { return role_ == Role::kStanding || waited_ > 0; }

 private:
  bool is_leant_on(const std::string& self, const std::vector<AnchorNeighbour>& neighbours) const;
  void note_steps(const std::vector<AnchorNeighbour>& neighbours);
  void explore_or_return(const std::string& self, double error, double walked_m,
                         const std::vector<AnchorNeighbour>& neighbours, const AnchoredParams& params);
  void hand_over(const std::string& self, double walked_m, const std::vector<AnchorNeighbour>& neighbours);

  /// When a robot last moved, by what it says.
  struct Steps {
    double walked_m = -1;
    int decision = 0;
  };
  Role role_ = Role::kExploring;
  std::string leans_on_;
  int decisions_ = 0, waited_ = 0, alone_ = 0;
  std::map<std::string, Steps> steps_;
};

}  // namespace radioslam
