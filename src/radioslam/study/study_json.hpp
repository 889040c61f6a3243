// JSON output of `reproduce --json`. Values that could not be measured are null.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "radioslam/study/aoa/aoa_paths.hpp"
#include "radioslam/study/aoa/aoa_table.hpp"
#include "radioslam/study/distributed_optimization/distributed_study.hpp"
#include "radioslam/study/fingerprints/fingerprint_tables.hpp"
#include "radioslam/study/fingerprints/sequence_table.hpp"
#include "radioslam/study/fingerprints/threshold_sweep.hpp"
#include "radioslam/study/overlap_growth/overlap_growth.hpp"
#include "radioslam/study/robustness_map/robustness_map.hpp"
#include "radioslam/study/team/team_study.hpp"
#include "radioslam/study/verification_budget/budget_study.hpp"
#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"
#include "radioslam/study/wi_closure_kitti/wi_closure_kitti.hpp"
#include "radioslam/study/wi_closure_table1/wi_closure_table1.hpp"

namespace radioslam {

/// {"table", "published": {...}, "seeds": [{"seed", "cut", "links", "joint": {...}, "link": {...}, ...}]}
nlohmann::ordered_json wi_closure_kitti_json(const std::vector<WiClosureKitti>& seeds);

/// {"table", "published": {...}, "angles": {...}, "seeds": [{"seed", "search": {...}, "defaults":
///   {"without_radio": {...}, "unpruned": {...}, "pruned": {...}}, "disco": {...}, "loosened_disco": {...},
///   "angles": [{"paths", "direct_path", "path_weights", "accepted"}]}]}; paths count from 0, a direct path
/// of -1 is that of an angle without one.
nlohmann::ordered_json wi_closure_hall_json(const std::vector<WiClosureHall>& halls);

/// {"table", "published": {...}, "seeds": [{"cut", "links", ...}]}; a seed has the keys of a hall's, without
/// "disco".
nlohmann::ordered_json wi_closure_table1_json(const std::vector<WiClosureTable1>& seeds);

/// {"table", "axes": {...}, "first_seed", "seeds", "cells": [{"sigma_angle_deg", "links", "false_paths",
///   "ratio", ...}]}: a cell's summary.
nlohmann::ordered_json robustness_json(const RobustnessMap& map);

/// {"table", "seed", "joint": {"exponent", "towns": [{"poses", "pairs", "kept", "distances_evaluated",
///   "prepare_s", "search_s", "all_pairs_s"}]}, "link": {...}}
nlohmann::ordered_json overlap_growth_json(const OverlapGrowth& growth);

/// {"table", "medians": [{"scenario", "order", "share", "registrations", "verified", "ate_m", "ratio"}],
///   "missions": [{"scenario", "seed", "descriptor_bytes", "descriptor_bytes_all", "all": {...}, "runs":
///   [{"order", "share", "registrations", "verified", "ate_m"}]}]}; ratio is that of the error to the one
/// without a bound, "all".
nlohmann::ordered_json verification_budget_json(const std::vector<BudgetMission>& missions);

/// {"table", "teams": [{"name", "robots", "poses", "factors", "factors_between", "bytes_of_all_graphs",
/// "runs":
///   [{"method", "settled", "rounds", "bytes", "relative_gap", "central_cost", "rounds_to_optimum",
///   "bytes_to_optimum", "trace": [[round, bytes up to its end, relative gap]]}]}]}; later rounds are thinned
/// out in the trace, and those before the robots are in one frame are left out.
nlohmann::ordered_json distributed_optimization_json(const std::vector<DistributedTeam>& teams);

/// {"table", "first_seed", "descriptor_bytes", "cases": [{"robots", "path_m", "loss", "partition_s", "seeds":
///   [{"run_ate_m", "agent_ate_m", "way_ate_m", "way_share", "all_know_all", "settled_s", "messages", "lost",
///   "bytes", "bytes_at_one", "bytes_to_all", "bytes_of_descriptors", "bytes_boxes_first"}]}]}
nlohmann::ordered_json team_json(const TeamStudy& study);

/// {"table", "groups": [{"sight", "motion", "ours": {"links", "median_error_rad", "within_10_deg",
///   "best_of_4_within_10_deg", "within_1_645_sigma"}, "authors_same_trials": {...}, "authors_all": {...}}],
///   "links": [{"trial", "transmitter", "sight", "motion", "true_azimuth_rad", "error_rad", "peaks": [...],
///   "authors_errors_rad", "reason"}]}
nlohmann::ordered_json aoa_json(const std::vector<AoaLink>& links, const std::vector<WsrResult>& published);

/// {"table", "cells": [{"profile", "cards", "runs": [{"seed", "measured", "found", "direct_error_rad",
///   "strongest_error_rad", "ghosts"}]}]}
nlohmann::ordered_json aoa_paths_json(const std::vector<AoaPathsCell>& cells);

/// {"table", "cells": [{"least_similarity", "window_way_m", "missions", "candidates", "accepted":
///   [{"error_m", "error_rad", "nees", "right"}], "measure", "without_truth"}]}; the last two where they say
/// something.
nlohmann::ordered_json sequence_json(const std::vector<SequenceCell>& cells);

/// {"table", "first_seed" (or "missions": names), "defaults_ate_m": [by mission], "dead_reckoning_ate_m",
/// "cells": [{"measure",
///   "sigma_detection", "nu_s_m", "nu_p_m", "published_m": [Test I, Test II], "ate_m": [by mission]}]}
nlohmann::ordered_json fingerprint_tables_json(const FingerprintTables& tables);

/// {"table", "missions": [{"seed" (or "mission": name), "measure" (where asked for), "dead_reckoning_ate_m",
/// "default_ate_m", "best": {...},
///   "default_over_best", "default_over_dead_reckoning", "cells": [{"nu_m", "loss_sigmas", "ate_m"}]}]};
/// loss_sigmas is null for least squares.
nlohmann::ordered_json threshold_sweep_json(const std::vector<SweptMission>& missions);

}  // namespace radioslam
