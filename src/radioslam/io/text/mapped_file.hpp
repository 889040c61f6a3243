// Memory-mapped input file, for files that may be larger than the memory.
#pragma once

#include <filesystem>
#include <string_view>

namespace radioslam {

class MappedFile {
 public:
  /// Refuses (InputError) a path that is missing, is a folder or cannot be read. The file must not shrink
  /// while mapped.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

}  // namespace radioslam
