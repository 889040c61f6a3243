// Finds the CSV files of an external data set.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace radioslam {

/// The file itself, or every *.csv below the folder, sorted by name. Refuses (InputError) a source without
/// CSV files, and file names that are not valid robot names or appear twice.
std::vector<std::filesystem::path> find_csv_files(const std::filesystem::path& source);

/// Name of a data set: that of its folder, or of its file without the extension.
std::string name_of_source(const std::filesystem::path& source);

}  // namespace radioslam
