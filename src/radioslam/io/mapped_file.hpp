// A file as bytes in memory that the system fetches when they are looked at, for files larger than memory.
#pragma once

#include <filesystem>
#include <string_view>

namespace radioslam {

class MappedFile {
 public:
  /// Refuses (InputError) what is missing, is a folder or cannot be read. The file must not shrink meanwhile.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::string_view bytes() const { return bytes_; }

 private:
  std::string_view bytes_;
};

}  // namespace radioslam
