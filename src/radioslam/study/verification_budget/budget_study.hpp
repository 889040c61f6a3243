// Error of a team over the number of scans that are registered between its robots (`run
// --max-verifications`), in three orders: by worth, by the similarity of descriptors, and at random.
//
// Two robots in a hall of identical pillars, and three in streets. Each mission's recordings are measured
// once for all its runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/joint/places/verification_budget.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

inline constexpr double kBudgetShares[] = {0.05, 0.1, 0.2, 0.5, 1};

struct BudgetRun {
  VerificationBudget::Order order = VerificationBudget::Order::kWorth;
  double share = 1;  ///< of the registrations without a bound
  double registrations = 0, verified = 0;
  std::optional<double> ate_m;  ///< nothing if the team is not in one frame
};

/// A mission's runs.
struct BudgetMission {
  std::string scenario;
  std::uint64_t seed = 1;
  double descriptor_bytes = 0, descriptor_bytes_all = 0;
  BudgetRun all;                ///< without a bound
  std::vector<BudgetRun> runs;  ///< by order, then share
};

BudgetMission study_budget(const std::string& scenario, const Simulation& simulation, std::uint64_t seed,
                           const Progress& progress = {});

/// The hall and the streets of one seed. Cost: two to five minutes.
std::vector<BudgetMission> study_budgets(std::uint64_t seed, const Progress& progress = {});

const char* word_for(VerificationBudget::Order order);

/// The medians over all missions of one scenario.
struct BudgetMedian {
  std::string scenario;
  VerificationBudget::Order order = VerificationBudget::Order::kWorth;
  double share = 1;
  std::optional<double> registrations, verified, ate_m;
  std::optional<double> ratio;  ///< of the error to that without a bound
};
std::vector<BudgetMedian> budget_medians(const std::vector<BudgetMission>& missions);

StudyTable budget_table(const std::vector<BudgetMission>& missions);

}  // namespace radioslam
