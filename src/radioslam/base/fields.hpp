// One list of fields per parameter struct. It feeds the configuration file, `--set`, validation and the
// report, so that a name, a unit or a range stands in one place only.
//
//   struct FingerprintParams {
//     double window_s = 5;   ///< length of a fingerprint's window
//     template <class Self, class Visitor>
//     static void visit_fields(Self& self, Visitor&& visit) {
//       visit(Field{"window_s", "s", 0.1, 600, "length of a fingerprint's window; seed value"},
//       self.window_s);
//     }
//   };
//
// A visitor is called as visit(const Field&, value&) with value a double, int, bool or std::string.
// A struct of such structs names them: static void visit_sections(Self& self, Visitor&& visit) calls
// visit("fingerprint", self.fingerprint), which makes the key "fingerprint.window_s".
#pragma once

#include <string_view>

namespace radioslam {

/// What a parameter is called, measured in and allowed to be.
struct Field {
  std::string_view name;
  std::string_view unit;          ///< "" for a pure number
  double minimum = 0;             ///< inclusive; ignored for text
  double maximum = 0;             ///< inclusive
  std::string_view meaning;       ///< one line, with the source of the default
  std::string_view choices = {};  ///< for text: the allowed values, separated by '|'
};

}  // namespace radioslam
