// The CSV files of someone else's dataset.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace radioslam {

/// The file itself, or every *.csv below the folder, in the order of their names. Refuses (InputError) a
/// source without any, and files whose names cannot be robots' or are equal.
std::vector<std::filesystem::path> find_csv_files(const std::filesystem::path& source);

/// What a dataset is called: the name of its folder or, without the extension, file.
std::string name_of_source(const std::filesystem::path& source);

}  // namespace radioslam
