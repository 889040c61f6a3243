#include "radioslam/base/scratch_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>
#include <vector>

#include "radioslam/base/input_error.hpp"

namespace radioslam {
namespace {

std::string scratch_folder() {
  const char* given = std::getenv("TMPDIR");
  return given && *given ? given : "/var/tmp";
}

/// Also on file systems that cannot make a file without a name.
int open_unnamed(const std::string& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return file;
  std::string name = folder + "/radioslam-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

ScratchFile::~ScratchFile() {
  if (file_ >= 0) ::close(file_);
}

void ScratchFile::fail(const std::string& what) const {
  const std::string why = std::generic_category().message(errno);
  throw InputError(folder_, 0, "a temporary file " + what + ": " + why + "; " + remedy_);
}

void ScratchFile::open() {
  folder_ = scratch_folder();
  file_ = open_unnamed(folder_);
  if (file_ < 0) fail("cannot be made");
}

std::uint64_t ScratchFile::append(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  if (file_ < 0) open();
  const std::uint64_t begin = size_;
  while (!bytes.empty()) {
    const ::ssize_t written = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<::off_t>(size_));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(written));
    size_ += static_cast<std::uint64_t>(written);
  }
  return begin;
}

void ScratchFile::read(std::uint64_t begin, std::span<char> bytes) const {
  while (!bytes.empty()) {
    const ::ssize_t got = ::pread(file_, bytes.data(), bytes.size(), static_cast<::off_t>(begin));
    if (got < 0 && errno == EINTR) continue;
    if (got == 0) errno = EIO;
    if (got <= 0) fail("cannot be read");
    bytes = bytes.subspan(static_cast<std::size_t>(got));
    begin += static_cast<std::uint64_t>(got);
  }
}

}  // namespace radioslam
