// An agent's scans: loops within the robot, and closures with those others of which it asks for.
//
// Of two robots, the first by name compares: it asks for the other's clouds where, as the team is estimated,
// they show what it has seen itself, and registers them in its own map. Robots that nothing else aligns are
// not compared. What holds is said in its log, and judged by everybody.
//
// Registrations, within the robot and between robots, have one budget, a share of the time; what it does not
// reach waits, the worthiest first.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "radioslam/team/agent_estimate.hpp"
#include "radioslam/team/messages.hpp"

namespace radioslam {

class AgentScans {
 public:
  explicit AgentScans(std::string self) : self_(std::move(self)) {}

  void set_scanner(const ScannerFacts& scanner) { own_.set_scanner(scanner); }
  void add(Stamp keyframe, StoredCloud cloud);
  /// Of those, the ones that the robot's journal may lack.
  const std::vector<Stamp>& not_kept() const { return not_kept_; }
  void note_kept() { not_kept_.clear(); }
  /// What the journal had when the robot's program was started again: one of its own clouds, as cloud() gave
  /// it, and a closure that its log says.
  void remember(const CloudMessage& cloud);
  void note_said(const ClosureRecord& closure);
  /// A cloud that was asked for; false: it is none.
  bool take(const std::string& peer, const CloudMessage& cloud);
  /// One of its own; nothing if there is none, or none that a message holds.
  std::optional<CloudMessage> cloud(Stamp keyframe) const;

  /// Whom to ask for which clouds now, of robots that are heard.
  std::map<std::string, CloudWant> wants(const AgentEstimate& estimate, const std::set<std::string>& heard,
                                         Stamp now);
  /// Work that is due. Nothing while some is done.
  std::optional<ScanJob> job(const AgentEstimate& estimate, Stamp now);
  /// The new closures, encoded. `own`: the robot's keyframes as its log says them.
  std::vector<std::string> done(const ScanResult& result, const LoggedKeyframes& own);
  std::size_t clouds() const { return clouds_; }
  /// This robot's, or those of another robot that it has; null if it has none.
  const ScansSoFar* scans_of(const std::string& robot) const {
    if (robot == self_) return &own_;
    const auto other = others_.find(robot);
    return other == others_.end() ? nullptr : &other->second;
  }
  const ScansSoFar& own() const { return own_; }
  const std::map<std::string, ScansSoFar>& others() const { return others_; }
  /// Whether work is done, or will be.
  bool is_busy() const { return is_working_ || news_ > 0 || has_left_out_; }

 private:
  struct Asked {
    Stamp at;
    int times = 0;
  };

  std::string self_;
  ScansSoFar own_;
  std::map<std::string, ScansSoFar> others_;
  std::shared_ptr<const RecognisedPlaces> tried_;
  CloudStore store_;
  std::vector<Stamp> not_kept_;
  std::map<std::pair<std::string, Stamp>, Asked> asked_;
  std::set<std::tuple<std::string, Stamp, Stamp>> said_;
  std::size_t clouds_ = 0, news_ = 0;  ///< news: of these, since the last job
  std::optional<Stamp> worked_, wanted_;
  bool is_working_ = false, has_left_out_ = false;
};

}  // namespace radioslam
