// Notes that depend on a run's result: made when it is complete, so that they are true of it.
//
// What the checks before a run find is a finding about the recordings. It becomes a note only if the result
// does not refute it: a robot that nothing but its scans ties to the others may be in their frame after all,
// and links that seem not to fit may be accepted.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// The findings as notes, those that the result refutes left out. Findings of the kind not-connected are left
/// out, too: component_notes() says where such robots are.
std::vector<std::string> finding_notes(const std::vector<Finding>& findings, const RunResult& result);

/// One note per frame besides the first, with the placed robots that are in it.
std::vector<std::string> component_notes(const RunResult& result);

/// One note per kind of measurement between robots of which there are several and all were rejected, with the
/// most frequent reason. Scans that were compared are left out: most of those never fit.
std::vector<std::string> rejection_notes(const std::vector<ClosureResult>& closures);

/// A note where nothing but scans ties robots to each other and the scans of a third of the compared places
/// or more fit elsewhere, too: look-alikes may agree with one another, and then win together. `elsewhere`:
/// the reason of those.
std::optional<std::string> look_alike_note(const std::vector<ClosureResult>& closures,
                                           std::string_view elsewhere);

/// Of a common frame with that note: 6 of 12 such were right in halls of identical pillars.
inline constexpr double kMaxLookAlikeWeight = 0.5;

/// Note on the constant errors of ranges that the estimate corrects: the largest one.
std::optional<std::string> range_bias_note(const std::vector<RangeBiasResult>& biases);

}  // namespace radioslam
