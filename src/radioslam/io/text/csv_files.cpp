#include "radioslam/io/text/csv_files.hpp"

#include <algorithm>
#include <set>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

std::vector<std::filesystem::path> find_csv_files(const std::filesystem::path& source) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::is_directory(source))
    files = {source};
  else
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source))
      if (entry.is_regular_file() && entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.empty()) throw InputError(source.string(), 0, "contains no *.csv");
  std::set<std::string> names;
  for (const auto& file : files) {
    const std::string name = file.stem().string();
    if (!is_valid_id(name)) throw InputError(file.string(), 0, "its name is not a valid robot name");
    if (!names.insert(name).second) throw InputError(file.string(), 0, "another file has the same name");
  }
  return files;
}

std::string name_of_source(const std::filesystem::path& source) {
  const std::filesystem::path path = std::filesystem::absolute(source).lexically_normal();
  return (path.filename().empty() ? path.parent_path() : path).stem().string();
}

}  // namespace radioslam
