// A temporary file without a name, for data that would fill the memory: what is appended can be read again.
//
// It is made on the first append, in $TMPDIR or, since /tmp is memory on many systems, in /var/tmp. The
// system removes it with the program, however that ends. Thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

namespace radioslam {

class ScratchFile {
 public:
  /// `remedy`: what the user can do when the file cannot be written, for the message.
  explicit ScratchFile(std::string remedy) : remedy_(std::move(remedy)) {}
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Returns where it begins. Throws InputError where it cannot be written, as on a full disk.
  std::uint64_t append(std::string_view bytes);
  /// What was appended there. Throws InputError where it cannot be read.
  void read(std::uint64_t begin, std::span<char> bytes) const;

 private:
  void open();
  [[noreturn]] void fail(const std::string& what) const;

  std::string remedy_, folder_;
  std::mutex mutex_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace radioslam
