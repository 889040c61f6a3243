// What looks wrong in a mission: a fault of a recording or of its description, with its likeliest correction.
#pragma once

#include <string>

namespace radioslam {

enum class Severity {
  kError,    ///< certain: no estimate from this mission can be trusted
  kWarning,  ///< likely: the estimate may be worse than it looks
};

/// One finding. `found`, `expected` and `advice` are parts of a sentence, without a full stop.
struct Finding {
  std::string kind;  ///< one word, e.g. "clock" or "unit"; docs/formats.md lists them
  Severity severity = Severity::kWarning;
  std::string robot;  ///< id; empty if no robot is meant
  std::string file;   ///< relative to the mission's folder; empty if no file is meant
  std::string found;
  std::string expected;
  std::string advice;
};

/// "robots/a/odometry.tum: found ..., expected ...; advice".
inline std::string text_of(const Finding& finding) {
  std::string text = finding.file.empty() ? "" : finding.file + ": ";
  text += finding.found;
  if (!finding.expected.empty()) text += "; expected " + finding.expected;
  if (!finding.advice.empty()) text += "; " + finding.advice;
  return text;
}

}  // namespace radioslam
