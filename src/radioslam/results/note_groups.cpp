#include "radioslam/results/note_groups.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <utility>

namespace radioslam {
namespace {

constexpr std::size_t kMaxNamed = 8;  // robots in one line
constexpr char kRobot = '\1', kNumber = '\2';

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)); }

bool begins_word(const std::string& text, std::size_t at) { return at == 0 || !is_of_word(text[at - 1]); }

/// The longest name that is a word of the text there; `names` are in falling order of length.
const std::string* name_at(const std::string& text, std::size_t at, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const std::size_t end = at + name.size();
    if (!name.empty() && text.compare(at, name.size(), name) == 0 &&
        (end == text.size() || !is_of_word(text[end])))
      return &name;
  }
  return nullptr;
}

std::size_t end_of_number(const std::string& text, std::size_t at) {
  while (at < text.size() &&
         (is_digit(text[at]) || (text[at] == '.' && at + 1 < text.size() && is_digit(text[at + 1]))))
    ++at;
  return at;
}

struct Pattern {
  std::string text;  ///< the note without names and numbers
  std::vector<std::string> robots;
};

Pattern pattern_of(const std::string& note, const std::vector<std::string>& names) {
  Pattern pattern;
  for (std::size_t at = 0; at < note.size();) {
    const std::string* name = begins_word(note, at) ? name_at(note, at, names) : nullptr;
    if (name) {
      pattern.robots.push_back(*name);
      pattern.text += kRobot;
      at += name->size();
    } else if (is_digit(note[at]) && begins_word(note, at)) {
      pattern.text += kNumber;
      at = end_of_number(note, at);
    } else {
      pattern.text += note[at++];
    }
  }
  return pattern;
}

/// The names in the first place in which they differ: "a" may be a name, too.
std::vector<std::string> differing(const std::vector<std::vector<std::string>>& robots) {
  std::vector<std::string> names;
  for (std::size_t place = 0; place < robots.front().size() && names.size() < 2; ++place) {
    names.clear();
    for (const auto& of_note : robots)
      if (std::find(names.begin(), names.end(), of_note[place]) == names.end())
        names.push_back(of_note[place]);
  }
  return names;
}

}  // namespace

std::vector<NoteGroup> grouped_notes(const std::vector<std::string>& notes,
                                     const std::vector<std::string>& robots) {
  std::vector<std::string> names = robots;
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  std::vector<NoteGroup> groups;
  std::vector<std::vector<std::vector<std::string>>> robots_of;  // per group and note
  std::map<std::string, std::size_t> of_pattern;
  for (const std::string& note : notes) {
    Pattern pattern = pattern_of(note, names);
    const auto [entry, is_new] = of_pattern.try_emplace(std::move(pattern.text), groups.size());
    if (is_new) groups.emplace_back(), robots_of.emplace_back();
    groups[entry->second].notes.push_back(note);
    robots_of[entry->second].push_back(std::move(pattern.robots));
  }
  for (std::size_t g = 0; g < groups.size(); ++g) groups[g].robots = differing(robots_of[g]);
  return groups;
}

std::string line_of(const NoteGroup& group) {
  std::string line = group.notes.front();
  if (group.notes.size() == 1) return line;
  line += " (" + std::to_string(group.notes.size()) + " notes of this kind";
  for (std::size_t k = 0; k < std::min(kMaxNamed, group.robots.size()); ++k)
    line += (k == 0 ? ": " : ", ") + group.robots[k];
  if (group.robots.size() > kMaxNamed) line += ", ...";
  return line + "; summary.json has all)";
}

}  // namespace radioslam
