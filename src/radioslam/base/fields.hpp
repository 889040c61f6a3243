// One list of fields per parameter struct. It feeds the configuration file, `--set`, validation and the
// report, so that name, unit and range are defined in one place only.
//
//   struct FingerprintParams {
//     double window_s = 5;
//     template <class Self, class Visitor>
//     static void visit_fields(Self& self, Visitor&& visit) {
//       RADIOSLAM_FIELD(window_s, "s", 0.1, 600, "length of a fingerprint's window");
//     }
//   };
//
// The macro calls visit(Field{"window_s", "s", 0.1, 600, "length of a fingerprint's window"}, self.window_s):
// a visitor gets a const Field& and a value&, which is a double, int, bool or std::string.
// A struct of such structs names them: static void visit_sections(Self& self, Visitor&& visit) calls
// visit("fingerprint", self.fingerprint), which makes the key "fingerprint.window_s".
#pragma once

#include <string_view>

namespace radioslam {

/// Name, unit, range and description of a parameter.
struct Field {
  /// Who needs the parameter: everybody who uses the command, or only who studies one of its algorithms.
  enum class Level { kBasic, kExpert };

  std::string_view name;
  std::string_view unit;          ///< "" for a pure number
  double minimum = 0;             ///< inclusive; ignored for text
  double maximum = 0;             ///< inclusive
  std::string_view description;   ///< one self-contained line
  std::string_view choices = {};  ///< for text: the allowed values, separated by '|'
  Level level = Level::kExpert;

  /// The same field as one of the basic parameters.
  constexpr Field basic() const {
    Field field = *this;
    field.level = Level::kBasic;
    return field;
  }
};

}  // namespace radioslam

/// In visit_fields: a field with the name of the member `member`; the other arguments are those of Field.
/// A field with another name than its member is visited without the macro.
#define RADIOSLAM_FIELD(member, ...) visit(::radioslam::Field{#member, __VA_ARGS__}, self.member)
/// The same for one of the basic parameters.
#define RADIOSLAM_BASIC_FIELD(member, ...) \
  visit(::radioslam::Field{#member, __VA_ARGS__}.basic(), self.member)
